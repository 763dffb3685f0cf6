// SPDX-License-Identifier: Apache-2.0
// Bids for the focus as rows.
import type { Bid } from "../server";
import { fill, h, setText, svg } from "../shell/h";
import { help, meanings } from "../shell/help";
import { Pace } from "../shell/pace";
import { BidHistory } from "./bids";

const chart = { width: 120, height: 24 }; // [px]
const shownSeconds = 30;
const drawPeriod = 200; // [ms], so that numbers can be read

/** A button that explains the bids. */
export const bidHelp = (): HTMLElement => help("a bid", `${meanings.bid} ${meanings.focus}`);

/** A row for each task: its bid as a bar and a number, and the last 30 s. */
export class BidRows {
  readonly element = h("ul.bid-rows");
  private readonly rows = new Map<number, BidRow>();
  private readonly history = new BidHistory(shownSeconds);
  private readonly pace = new Pace(drawPeriod);

  constructor(private readonly nameOf: (mode: number) => string) {}

  /** Adds the rows of modes, which stay, so that no row moves when a task bids. */
  addModes(modes: Iterable<number>): void {
    const before = this.rows.size;
    for (const mode of modes) {
      if (!this.rows.has(mode)) this.rows.set(mode, new BidRow(this.nameOf(mode)));
    }
    if (this.rows.size === before) return;
    const inOrder = [...this.rows].sort(([a], [b]) => a - b);
    fill(
      this.element,
      inOrder.map(([, row]) => row.element),
    );
  }

  /** Takes the newest bids. @param time  [s] */
  take(bids: readonly Bid[], time: number): void {
    this.history.add(time, bids);
    this.addModes(bids.map(({ mode }) => mode));
    this.pace.run(() => this.draw(bids));
  }

  /** Shows that no bids are known. */
  clear(): void {
    this.pace.close();
    this.draw([]);
  }

  close(): void {
    this.pace.close();
  }

  private draw(bids: readonly Bid[]): void {
    for (const [mode, row] of this.rows) {
      const bid = bids.find((each) => each.mode === mode);
      row.update(bid, pathsOf(this.history.of(mode), this.history.seconds));
    }
  }
}

class BidRow {
  private readonly bar = h("div.bid-now");
  private readonly value = h("span.bid-value", "–");
  private readonly note = h("span.bid-note.small");
  private readonly line = svg("path.bid-line");
  private readonly focus = svg("path.bid-focus");
  readonly element: HTMLElement;

  constructor(name: string) {
    const box = {
      viewBox: `0 0 ${chart.width} ${chart.height}`,
      preserveAspectRatio: "none",
      "aria-hidden": "true",
    };
    this.element = h("li.bid", [
      h("span.bid-name", { title: name }, name),
      h("div.bid-bar", { "aria-hidden": "true" }, this.bar),
      this.value,
      svg("svg.bid-chart", box, [this.line, this.focus]),
      this.note,
    ]);
  }

  update(bid: Bid | undefined, paths: ReturnType<typeof pathsOf>): void {
    this.element.classList.toggle("in-focus", bid?.inFocus === true);
    this.bar.style.width = `${100 * Math.min(1, bid?.salience ?? 0)}%`;
    setText(this.value, bid ? bid.salience.toFixed(2) : "–");
    setText(this.note, bid?.ofPerson ? "person" : bid?.inFocus ? "focus" : "");
    this.line.setAttribute("d", paths.line);
    this.focus.setAttribute("d", paths.focus);
  }
}

/** Saliences over time as a line, and bars below while in focus. */
function pathsOf(samples: ReturnType<BidHistory["of"]>, seconds: number) {
  const end = samples.at(-1)?.time ?? 0;
  const x = (time: number): string => (chart.width * (1 - (end - time) / seconds)).toFixed(1);
  const y = (salience: number): string =>
    (chart.height - 4 - (chart.height - 6) * Math.min(1, salience)).toFixed(1);
  let line = "";
  let focus = "";
  samples.forEach(({ time, salience, inFocus }, i) => {
    const before = samples[i - 1];
    if (before && before.salience !== salience) line += `L${x(time)} ${y(before.salience)}`;
    line += `${before ? "L" : "M"}${x(time)} ${y(salience)}`;
    if (inFocus && before) focus += `M${x(before.time)} ${chart.height - 1}H${x(time)}`;
  });
  return { line, focus };
}
