// SPDX-License-Identifier: Apache-2.0
// A workspace: which task has the focus and why, and a small chart of each task's bids.
import type { GraphState, Server, Stream } from "../server";
import { fill, h, setText, svg } from "../shell";
import { BidHistory, bidsOf, whyText, type Bid } from "./bids";

const chart = { width: 240, height: 34 }; // [px]

export class WorkspaceView {
  private readonly why = h("p.why", { role: "status" });
  private readonly charts = h("div.bid-charts");
  readonly element: HTMLElement;
  private readonly history = new BidHistory();
  private readonly stream: Stream;
  private readonly off: () => void;
  private bids: readonly Bid[] = [];
  private drawn = 0; // [ms]

  constructor(
    private readonly server: Server,
    private readonly name: string,
  ) {
    this.element = h("section.workspace", { "aria-label": `Focus, by ${name}` }, [
      this.why,
      this.charts,
    ]);
    this.off = server.onConnection(({ status }) => status === "lost" && setText(this.why, ""));
    this.stream = server.stream(`${name}.standings`, { rate: 10 });
    this.stream.on("message", ({ message, at }) => {
      this.bids = bidsOf(message);
      this.history.add(at / 1000, this.bids);
      if (at - this.drawn < 200) return;
      this.drawn = at;
      this.draw();
    });
  }

  close(): void {
    this.off();
    this.stream.close();
  }

  private draw(): void {
    const { state, session } = this.server;
    if (!state) return;
    const parameters = state.modules.find((module) => module.name === this.name)?.parameters ?? {};
    const rules = {
      margin: Number(parameters.margin ?? 0),
      dwell: Number(parameters.dwell ?? 0),
      stopped: session?.stopped === true,
    };
    const nameOf = (mode: number): string => modeName(state, mode);
    const why = whyText(this.bids, rules, nameOf);
    setText(this.why, why);
    fill(
      this.charts,
      this.history.modes().map((mode) => this.drawMode(mode, nameOf(mode))),
    );
  }

  /** The last minute of a mode: its salience as a line, and a bar while in focus. */
  private drawMode(mode: number, name: string): HTMLElement {
    const samples = this.history.of(mode);
    const end = samples.at(-1)?.time ?? 0;
    const x = (time: number): string =>
      (chart.width * (1 - (end - time) / this.history.seconds)).toFixed(1);
    const y = (salience: number): string =>
      (chart.height - 4 - (chart.height - 6) * salience).toFixed(1);
    let line = "";
    let bars = "";
    samples.forEach(({ time, salience, inFocus }, i) => {
      const before = samples[i - 1];
      if (before && before.salience !== salience) line += `L${x(time)} ${y(before.salience)}`;
      line += `${before ? "L" : "M"}${x(time)} ${y(salience)}`;
      if (inFocus && before) bars += `M${x(before.time)} ${chart.height - 1}H${x(time)}`;
    });
    const bid = this.bids.find((each) => each.mode === mode);
    const now = bid ? bid.salience.toFixed(2) + (bid.ofPerson ? " (a person's)" : "") : "no bid";
    return h("div", { class: bid?.inFocus ? "bid small in-focus" : "bid small" }, [
      h("span.bid-name", name),
      svg(
        "svg.bid-chart",
        {
          viewBox: `0 0 ${chart.width} ${chart.height}`,
          preserveAspectRatio: "none",
          role: "img",
          "aria-label": `Bids of ${name} in the last minute; now ${now}`,
        },
        [svg("path.bid-line", { d: line }), svg("path.bid-focus", { d: bars })],
      ),
      h("span.bid-value", now),
    ]);
  }
}

/** Name of a mode; "mode 7" if it has none. */
export function modeName(state: GraphState, mode: number): string {
  const found = Object.entries(state.modes).find(([, number]) => number === mode);
  return found?.[0] ?? `mode ${mode}`;
}
