// SPDX-License-Identifier: Apache-2.0
// The tasks of the robot as buttons, with their bids. Their size depends on neither.
import { modesInFocus, type GraphState, type Server, type Unsubscribe } from "../server";
import { button, fill, h, meanings, setText } from "../shell";
import type { Seat } from "./holder";

export class TaskButtons {
  readonly element = h("div.tasks", { role: "group", "aria-label": "Tasks" });
  private readonly end: Unsubscribe;
  private key = "";

  /** @param mayChoose  whether a task can be chosen now. */
  constructor(
    private readonly server: Server,
    private readonly seat: Seat,
    private readonly mayChoose: () => boolean,
  ) {
    this.end = server.standings.on(() => this.showBids());
  }

  update(state: GraphState): void {
    const modes = Object.entries(state.modes).sort((a, b) => a[1] - b[1]);
    const can = this.mayChoose();
    const isKnown = this.server.connection.status === "open";
    const inFocus = isKnown ? modesInFocus(state).map(({ number }) => number) : [];
    const key = JSON.stringify([modes, can, this.seat.task, inFocus]);
    if (this.key !== key) this.build(modes, can, inFocus);
    this.key = key;
    this.showBids();
  }

  private build(
    modes: readonly (readonly [string, number])[],
    can: boolean,
    inFocus: readonly number[],
  ): void {
    const active = document.activeElement;
    const focused = active instanceof HTMLElement && this.element.contains(active) ? active : null;
    fill(
      this.element,
      modes.length > 0 && this.drawRelease(can),
      modes.map(([name, number]) => this.draw(name, number, can, inFocus.includes(number))),
    );
    const again = focused && `[data-task="${CSS.escape(focused.dataset.task ?? "")}"]`;
    if (again) this.element.querySelector<HTMLElement>(again)?.focus();
  }

  close(): void {
    this.end();
  }

  private drawRelease(can: boolean): HTMLElement {
    return button("Let the robot decide", () => this.seat.release(), {
      "data-task": "",
      class: "task-button",
      "aria-pressed": String(can && this.seat.task === 0),
      disabled: !can,
      title: "Releases the head and keeps the seat",
    });
  }

  private draw(name: string, number: number, can: boolean, inFocus: boolean): HTMLElement {
    const isChosen = this.seat.task === number;
    const choose = () => (isChosen ? this.seat.release() : this.seat.choose(number));
    const what = isChosen ? "Release" : "Choose";
    const words = [h("span", name), inFocus && h("span.unseen", " in focus "), h("span.task-bid")];
    return button(words, choose, {
      "data-task": name,
      "data-number": number,
      class: inFocus ? "task-button in-focus" : "task-button",
      "aria-pressed": String(isChosen),
      disabled: !can,
      title: `${what} ${name}. The number is its bid. ${meanings.bid}`,
    });
  }

  private showBids(): void {
    const { state, standings } = this.server;
    const bids = Object.keys(state?.focus ?? {}).flatMap((name) => standings.of(name));
    for (const each of this.element.querySelectorAll<HTMLElement>("[data-number]")) {
      const bid = bids.find(({ mode }) => mode === Number(each.dataset.number));
      setText(each.lastElementChild!, bid ? bid.salience.toFixed(2) : "");
    }
  }
}
