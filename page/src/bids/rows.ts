// SPDX-License-Identifier: Apache-2.0
// The bids for the robot: each task's bid, now and in the last 30 s.
import type { GraphState } from "../server";
import { fill, h, setText, svg, type PanelHost, type PanelKind } from "../shell";
import { BidHistory, type Bid } from "./bids";
import { Standings } from "./standings";

const chart = { width: 120, height: 24 }; // [px]
const shownSeconds = 30;
const drawPeriod = 200; // [ms]

/** The bids of all workspaces: {kind: "bids"}. */
export const bidsPanel: PanelKind = (_, host) => {
  host.setTitle("Bids for the focus");
  const element = h("div.bids");
  const none = h("p.empty.muted", "This graph has no workspace, so no tasks bid.");
  const { server } = host;
  const views = new Map<string, WorkspaceView>();
  const standings = new Standings(server, 10, (workspace, bids, at) =>
    views.get(workspace)?.take(bids, at),
  );
  const show = (state: GraphState): void => {
    const names = Object.keys(state.focus);
    if (names.join() !== [...views.keys()].join() || !element.hasChildNodes()) {
      views.clear();
      for (const name of names) views.set(name, new WorkspaceView(host, name));
      const shown = [...views.values()].map((view) => view.element);
      fill(element, shown.length > 0 ? shown : none);
    }
    standings.follow(state);
    for (const view of views.values()) view.draw();
  };
  const ends = [
    server.onState(show),
    server.onConnection(() => server.state && show(server.state)),
  ];
  return {
    element,
    close: () => {
      for (const end of ends) end();
      standings.close();
    },
  };
};

class WorkspaceView {
  private readonly rows = h("ul.bid-rows");
  readonly element: HTMLElement;
  private readonly history = new BidHistory(shownSeconds);
  private readonly rowOf = new Map<number, BidRow>();
  private bids: readonly Bid[] = [];
  private drawn = 0; // [ms]

  constructor(
    private readonly host: PanelHost,
    private readonly name: string,
  ) {
    this.element = h("section", { "aria-label": `Bids at ${name}` }, this.rows);
  }

  take(bids: readonly Bid[], at: number): void {
    this.bids = bids;
    this.history.add(at / 1000, bids);
    if (at - this.drawn < drawPeriod) return;
    this.drawn = at;
    this.draw();
  }

  draw(): void {
    const { state, connection } = this.host.server;
    if (!state) return;
    const bids = connection.status === "open" ? this.bids : [];
    const modes = [...new Set([...modesOf(state, this.name), ...this.history.modes()])];
    if (modes.some((mode) => !this.rowOf.has(mode))) {
      for (const mode of modes) {
        if (!this.rowOf.has(mode)) this.rowOf.set(mode, new BidRow(modeName(state, mode)));
      }
      const inOrder = [...this.rowOf].sort(([a], [b]) => a - b);
      fill(
        this.rows,
        inOrder.map(([, row]) => row.element),
      );
    }
    for (const [mode, row] of this.rowOf) {
      row.update(
        bids.find((bid) => bid.mode === mode),
        this.history,
        mode,
      );
    }
  }
}

/** A task: its name, its bid as a bar and a number, and the last 30 s. */
class BidRow {
  private readonly bar = h("div.bid-now");
  private readonly value = h("span.bid-value");
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
    ]);
  }

  update(bid: Bid | undefined, history: BidHistory, mode: number): void {
    this.element.classList.toggle("in-focus", bid?.inFocus === true);
    this.element.setAttribute("aria-current", String(bid?.inFocus === true));
    this.element.title = bid?.ofPerson ? "a person's bid" : "";
    this.bar.style.width = `${100 * Math.min(1, bid?.salience ?? 0)}%`;
    setText(this.value, bid ? bid.salience.toFixed(2) : "–");
    const { line, focus } = pathsOf(history.of(mode), history.seconds);
    this.line.setAttribute("d", line);
    this.focus.setAttribute("d", focus);
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

/** The modes of the modules that obey a workspace. */
function modesOf(state: GraphState, workspace: string): number[] {
  const obeying = state.modules.filter((module) => module.workspace === workspace);
  return obeying.flatMap(({ mode }) => state.modes[mode] ?? []);
}

/** Name of a mode; "mode 7" if it has none. */
export function modeName(state: GraphState, mode: number): string {
  const found = Object.entries(state.modes).find(([, number]) => number === mode);
  return found?.[0] ?? `mode ${mode}`;
}
