// SPDX-License-Identifier: Apache-2.0
import { h, type PanelKind, type Shell } from "../shell";

/** The supervisor's seat: {kind: "seat"}. */
export const seatPanel: PanelKind = (_args, host) => {
  host.setTitle("Seat");
  return { element: h("div", { class: "seat" }) };
};

/** What is always visible in the header: the stop button. */
export function addStop(shell: Shell): void {
  shell.headerSlot.append();
}
