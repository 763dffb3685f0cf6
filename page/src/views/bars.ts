// SPDX-License-Identifier: Apache-2.0
// Bids for the focus as bars with the names of the tasks.
import { bidsOf, type Bid } from "../graph/bids";
import { modeName } from "../graph/workspace";
import type { Arrival } from "../server";
import { fill, h, setText } from "../shell/h";
import { help } from "../shell/help";
import type { Surroundings, View, ViewKind } from "./view";

const period = 200; // [ms]

interface Row {
  readonly element: HTMLElement;
  readonly meter: HTMLMeterElement;
  readonly value: HTMLElement;
  readonly note: HTMLElement;
}

export class BarsView implements View {
  private readonly rows = new Map<number, Row>();
  private readonly list = h("div.bar-list");
  readonly element = h("div.bars-view", [
    h("p.muted.small", [
      "Bids for the focus",
      help(
        "a bid",
        "A task bids for the robot with its salience, from 0 to 1. The workspace gives the focus, " +
          "which is the right to move the robot, to the highest bid. A person’s bid wins over all.",
      ),
    ]),
    this.list,
  ]);
  private drawn = -Infinity; // [ms]

  constructor(private readonly surroundings: Surroundings) {
    // All tasks of the graph, so that the rows keep their places.
    for (const mode of Object.values(surroundings.state?.modes ?? {})) this.rowOf(mode);
  }

  show({ message }: Arrival): void {
    const now = performance.now();
    if (now < this.drawn + period) return;
    this.drawn = now;
    const bids = new Map(bidsOf(message).map((bid) => [bid.mode, bid]));
    for (const mode of bids.keys()) this.rowOf(mode);
    for (const [mode, row] of this.rows) draw(row, bids.get(mode));
  }

  private rowOf(mode: number): Row {
    const known = this.rows.get(mode);
    if (known) return known;
    const { state } = this.surroundings;
    const name = state ? modeName(state, mode) : `mode ${mode}`;
    const meter = h("meter", { min: 0, max: 1, "aria-label": `Salience of ${name}` });
    const [value, note] = [h("span.mono"), h("span.bar-note.small")];
    const element = h("div.bar-row", [h("span.bar-name", name), meter, value, note]);
    const row = { element, meter, value, note };
    this.rows.set(mode, row);
    const inOrder = [...this.rows].sort(([a], [b]) => a - b);
    fill(
      this.list,
      inOrder.map(([, each]) => each.element),
    );
    return row;
  }
}

function draw({ element, meter, value, note }: Row, bid: Bid | undefined): void {
  element.classList.toggle("in-focus", bid?.inFocus === true);
  element.classList.toggle("silent", bid === undefined);
  meter.value = bid?.salience ?? 0;
  setText(value, bid ? bid.salience.toFixed(2) : "–");
  const notes = [bid?.inFocus && "in focus", bid?.ofPerson && "a person’s"];
  setText(note, bid ? notes.filter(Boolean).join(", ") : "does not bid");
}

/** The default view of a table that declares modes and their salience. */
export const barsView: ViewKind = {
  name: "bars",
  fits: ({ type }, { columns }) =>
    type === "table" && columns[0] === "mode" && columns[1] === "salience",
  make: async ({ surroundings }) => {
    await surroundings.ready();
    return new BarsView(surroundings);
  },
};
