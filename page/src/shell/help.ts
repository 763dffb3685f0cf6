// SPDX-License-Identifier: Apache-2.0
import { button, dialogBox, h } from "./h";

/** The words of the page, also for tooltips. */
export const meanings = {
  task: "What the robot can do, such as following a ball. It does one task at a time.",
  bid: "How much a task wants the robot, from 0 to 1. The highest bid gets the focus.",
  focus: "The task in focus moves the robot; all others wait.",
  seat: "The place of the driver. One page at a time has it, and its bids override all tasks.",
  stop: "Takes the focus from all tasks until a person clears the stop. It needs a working computer and network, so it does not replace a switch at the robot.",
} as const;

const keys: readonly [string, string][] = [
  ["Escape twice", "stop the robot"],
  ["Arrow keys or W A S D", "turn the head, in Drive; slowly with Shift"],
  ["Alt and an arrow key", "move a panel, from its menu ⋮ in Build"],
  ["?", "show this help"],
];

/** The dialog that explains the words and keys of the page. */
export function helpDialog(): HTMLDialogElement {
  const words = (entries: readonly (readonly [string, string])[]) =>
    h("dl", entries.map(([word, meaning]) => [h("dt", word), h("dd", meaning)]).flat());
  const dialog = dialogBox(
    "help-dialog",
    "Help",
    h("div.help-body", { tabindex: 0 }, [
      h("h2", "The three views"),
      words([
        ["Drive", "Take the seat, steer the head, choose its task."],
        ["Watch", "What the robot does, and why."],
        ["Build", "All streams, modules, parameters, the log and recordings, as panels."],
      ]),
      h("h2", "Words"),
      words(Object.entries(meanings)),
      h("h2", "Keys"),
      words(keys),
      button("Close", () => dialog.close()),
    ]),
  );
  return dialog;
}

let count = 0;

/** A button that explains a term, for pointers, keyboards and screen readers. */
export function help(term: string, text: string): HTMLElement {
  const id = `help-${++count}`;
  return h("span.help", [
    h(
      "button.help-button",
      { type: "button", popovertarget: id, "aria-label": `What is ${term}?`, title: text },
      "?",
    ),
    h("span.help-text.box", { id, popover: "auto", role: "note" }, text),
  ]);
}
