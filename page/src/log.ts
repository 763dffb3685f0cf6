// SPDX-License-Identifier: Apache-2.0
import { h, type PanelKind } from "./shell";

const mostLines = 500;

/** What the modules report, and the workspace on the focus: {kind: "log"}. */
export const logPanel: PanelKind = (_args, { server, setTitle }) => {
  setTitle("Log");
  const lines = h("div.log-lines", { role: "log", tabindex: 0, "aria-label": "Log" });
  const add = (module: string, text: string, level = "info", at?: Date): void => {
    const atEnd = lines.scrollTop + lines.clientHeight >= lines.scrollHeight - 4;
    const time = at && h("time.muted", at.toLocaleTimeString([], { hour12: false }));
    lines.append(h("div", { class: level }, [time, " ", h("b", module), " ", text]));
    while (lines.childElementCount > mostLines) lines.firstElementChild?.remove();
    if (atEnd) lines.scrollTop = lines.scrollHeight;
  };
  const ends = [
    // After connecting, the server sends the last lines again.
    server.onConnection(({ status }) => status === "open" && lines.replaceChildren()),
    server.onLog(({ module, text, level }) => add(module, text, level, new Date())),
  ];
  for (const { module, text, level } of server.log) add(module, text, level);
  return { element: lines, close: () => ends.forEach((end) => end()) };
};
