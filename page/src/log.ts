// SPDX-License-Identifier: Apache-2.0
import type { LogLine } from "./server";
import { h, type PanelKind } from "./shell";

const mostLines = 500;

/** What the modules report, and the workspace on the focus: {kind: "log"}. */
export const logPanel: PanelKind = (_args, { server, setTitle }) => {
  setTitle("Log");
  const lines = h("div.log-lines", { role: "log", tabindex: 0, "aria-label": "Log" });
  let isAtEnd = true;
  const follow = (): void => {
    if (isAtEnd) lines.scrollTop = lines.scrollHeight;
  };
  lines.onscroll = () => (isAtEnd = lines.scrollTop + lines.clientHeight >= lines.scrollHeight - 4);
  const resizing = new ResizeObserver(follow); // also when it is shown first
  resizing.observe(lines);
  const add = ({ module, text, level, at }: LogLine): void => {
    const time = h("time.muted", new Date(at).toLocaleTimeString([], { hour12: false }));
    lines.append(h("div", { class: level }, [time, " ", h("b", module), " ", text]));
    while (lines.childElementCount > mostLines) lines.firstElementChild?.remove();
    follow();
  };
  const ends = [
    // After connecting, the server sends the last lines again.
    server.onConnection(({ status }) => status === "open" && lines.replaceChildren()),
    server.onLog(add),
  ];
  server.log.forEach(add);
  const close = (): void => {
    resizing.disconnect();
    ends.forEach((end) => end());
  };
  return { element: lines, close };
};
