// SPDX-License-Identifier: Apache-2.0
import { outputsOf } from "../outputs";
import type { GraphState, Server } from "../server";
import { button, fill, h } from "./h";
import type { PanelArgs } from "./panel";

export interface Choice {
  readonly label: string;
  readonly detail: string;
  readonly args: PanelArgs;
}

/** Panels for any graph; filled by src/page.ts. */
export const standardPanels: Choice[] = [];

function modulesOf(state: GraphState | undefined): Choice[] {
  return (state?.modules ?? []).map(({ name, program }) => ({
    label: name,
    detail: `module, ${program.split("/").at(-1)}`,
    args: { kind: "module", name },
  }));
}

/** The dialog that opens panels. */
export function opener(server: Server, open: (args: PanelArgs) => void): HTMLDialogElement {
  let streams: Choice[] = [];
  const list = h("ul.choices");
  const choose = (args: PanelArgs) => {
    dialog.close();
    open(args);
  };
  const item = ({ label, detail, args }: Choice) =>
    h(
      "li",
      button([h("span", label), h("span.muted", detail)], () => choose(args)),
    );
  const show = () => {
    const typed = search.value.trim();
    const words = typed.toLowerCase().split(/\s+/);
    const found = [...standardPanels, ...streams, ...modulesOf(server.state)].filter(
      ({ label, detail }) =>
        words.every((word) => `${label} ${detail}`.toLowerCase().includes(word)),
    );
    const isPort = /^[\w-]+\.[\w-]+$/.test(typed) && !found.some(({ label }) => label === typed);
    if (isPort) {
      found.push({ label: typed, detail: "stream", args: { kind: "stream", port: typed } });
    }
    fill(list, found.map(item));
    if (found.length === 0) fill(list, h("li.muted", "No match."));
  };
  const search = h("input", {
    type: "search",
    "aria-label": "Panel, stream or module",
    placeholder: "panel, MODULE.PORT, or module",
    oninput: show,
    onkeydown: (event) => {
      if (event.key === "Enter") list.querySelector("button")?.click();
      else if (event.key === "ArrowDown") list.querySelector("button")?.focus();
      else return;
      event.preventDefault();
    },
  });
  list.addEventListener("keydown", (event) => {
    const buttons = [...list.querySelectorAll("button")];
    const at = buttons.findIndex((button) => button === document.activeElement);
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    (buttons[at + step] ?? search).focus();
  });
  const dialog = h(
    "dialog.opener.box",
    { "aria-label": "Open a panel", onclick: (event) => event.target === dialog && dialog.close() },
    h("div.opener-body.stack", [search, list]),
  );
  dialog.addEventListener("toggle", () => {
    if (!dialog.open) return;
    show();
    void outputsOf(server).then((all) => {
      streams = all.map(({ port, type }) => ({
        label: port,
        detail: type || "stream",
        args: { kind: "stream", port },
      }));
      if (dialog.open && !list.contains(document.activeElement)) show();
    });
  });
  return dialog;
}
