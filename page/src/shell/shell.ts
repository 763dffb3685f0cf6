// SPDX-License-Identifier: Apache-2.0
import type { Server } from "../server";
import { h } from "./h";
import { panelKinds, type PanelArgs } from "./panel";

/** The page: header, panels, status line. */
export class Shell {
  readonly element = h("div", { class: "shell" });
  /** Room in the header for what is always visible: the stop button, the task in focus. */
  readonly headerSlot = h("div", { class: "header-slot" });

  constructor(readonly server: Server) {
    this.element.append(this.headerSlot);
  }

  openPanel(args: PanelArgs): void {
    if (!panelKinds[args.kind]) this.say(`There is no panel ${args.kind}.`);
  }

  say(sentence: string): void {
    console.info(sentence);
  }
}
