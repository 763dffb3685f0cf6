// SPDX-License-Identifier: Apache-2.0
// The tasks of the robot as buttons, with their bids. Their size depends on neither.
import { Standings } from "../graph/standings";
import { modesInFocus, type GraphState, type Server } from "../server";
import { button, fill, h, meanings, setText } from "../shell";
import type { Seat } from "./holder";

const rate = 5; // of the shown bids [Hz]

export class TaskButtons {
  readonly element = h("div.tasks", { role: "group", "aria-label": "Tasks" });
  private readonly standings: Standings;
  private key = "";

  /** @param mayChoose  whether a task can be chosen now. */
  constructor(
    private readonly server: Server,
    private readonly seat: Seat,
    private readonly mayChoose: () => boolean,
  ) {
    this.standings = new Standings(server, rate, () => this.showBids());
  }

  update(state: GraphState): void {
    this.standings.follow(state);
    const modes = Object.entries(state.modes).sort((a, b) => a[1] - b[1]);
    const can = this.mayChoose();
    const isKnown = this.server.connection.status === "open";
    const inFocus = isKnown ? modesInFocus(state).map(({ number }) => number) : [];
    const key = JSON.stringify([modes, can, this.seat.task, inFocus]);
    if (this.key === key) return;
    this.key = key;
    const active = document.activeElement;
    const focused = active instanceof HTMLElement && this.element.contains(active) ? active : null;
    fill(
      this.element,
      modes.length > 0 && this.drawRelease(can),
      modes.map(([name, number]) => this.draw(name, number, can, inFocus.includes(number))),
    );
    const again = focused && `[data-task="${CSS.escape(focused.dataset.task ?? "")}"]`;
    if (again) this.element.querySelector<HTMLElement>(again)?.focus();
    this.showBids();
  }

  close(): void {
    this.standings.close();
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
    const { state, connection } = this.server;
    const workspaces = connection.status === "open" ? Object.keys(state?.focus ?? {}) : [];
    const bids = workspaces.flatMap((name) => this.standings.of(name));
    for (const each of this.element.querySelectorAll<HTMLElement>("[data-number]")) {
      const bid = bids.find(({ mode }) => mode === Number(each.dataset.number));
      setText(each.lastElementChild!, bid ? bid.salience.toFixed(2) : "");
    }
  }
}
