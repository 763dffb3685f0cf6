// SPDX-License-Identifier: Apache-2.0
import { h } from "./h";

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
