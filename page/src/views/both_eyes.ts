// SPDX-License-Identifier: Apache-2.0
// The depths of both eyes, side by side, in the same colours.
import { Coord, sentHeader, type Header } from "../mtp";
import type { Arrival } from "../server";
import { h } from "../shell/h";
import { SlowRange } from "./coding";
import { Pairing, type Side } from "./pairing";
import { ValuesView } from "./values";
import type { About, Source, View, ViewHost, ViewKind } from "./view";

/** The output with the depth of the other eye. */
function otherOf({ coord }: Header, { outputs }: About): string | undefined {
  const other = { [Coord.depth]: Coord.right_depth, [Coord.right_depth]: Coord.depth }[coord];
  return other && outputs.find(({ kind }) => kind?.coord === other)?.port;
}

/** A depth, and the view that shows it. */
interface Shown {
  readonly time: bigint;
  show(): void;
}

export class BothEyesView implements View {
  readonly element: HTMLElement;
  readonly tools: readonly HTMLElement[];
  private readonly own: ValuesView;
  private other?: { readonly source: Source; readonly view: ValuesView };
  private readonly pairing = new Pairing<Shown>();
  private readonly range = new SlowRange();

  constructor(private readonly host: ViewHost) {
    this.own = new ValuesView(host, this.range);
    this.tools = this.own.tools;
    this.element = h("div.both-eyes", this.own.element);
  }

  show(arrival: Arrival, sent: Header): void {
    if (!this.other) this.open(sent);
    this.take(this.own, arrival, sent);
  }

  close(): void {
    this.own.close();
    this.other?.source.close();
    this.other?.view.close();
  }

  /** Shows a depth with the other eye's of its time; in a replay both are of one time. */
  private take(view: ValuesView, arrival: Arrival, sent: Header): void {
    const show = (): void => view.show(arrival, sent);
    if (!this.other || this.host.source.isReplay) return show();
    const side: Side = sent.coord === Coord.depth ? "left" : "right";
    const pair = this.pairing.take(side, { time: sent.time, show });
    pair?.left.show();
    pair?.right.show();
  }

  private open(header: Header): void {
    const port = otherOf(header, this.host.about);
    if (port === undefined) return;
    const source = this.host.surroundings.open(port);
    const view = new ValuesView({ ...this.host, source }, this.range);
    this.other = { source, view };
    let sent: Header | undefined;
    source.on("header", (line) => (sent = sentHeader(line)));
    source.on("message", (arrival) => this.take(view, arrival, sent ?? arrival.message.header));
    if (header.coord === Coord.depth) this.element.append(view.element);
    else this.element.prepend(view.element);
  }
}

export const bothEyesView: ViewKind = {
  name: "both eyes",
  fits: (sent, about) => sent.scalar !== "u8" && otherOf(sent, about) !== undefined,
  make: (host) => new BothEyesView(host),
};
