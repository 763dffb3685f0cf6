// SPDX-License-Identifier: Apache-2.0
// The depths of both eyes, side by side, in the same colours.
import { Coord, sentHeader, type Header } from "../mtp";
import type { Arrival } from "../server";
import { h } from "../shell/h";
import { SlowRange } from "./coding";
import { ValuesView } from "./values";
import type { About, Source, View, ViewHost, ViewKind } from "./view";

/** The output with the depth of the other eye. */
function otherOf({ coord }: Header, { outputs }: About): string | undefined {
  const other = { [Coord.depth]: Coord.right_depth, [Coord.right_depth]: Coord.depth }[coord];
  return other && outputs.find(({ kind }) => kind?.coord === other)?.port;
}

export class BothEyesView implements View {
  readonly element: HTMLElement;
  readonly tools: readonly HTMLElement[];
  private readonly own: ValuesView;
  private other?: { readonly source: Source; readonly view: ValuesView };
  private readonly range = new SlowRange();

  constructor(private readonly host: ViewHost) {
    this.own = new ValuesView(host, this.range);
    this.tools = this.own.tools;
    this.element = h("div.both-eyes", this.own.element);
  }

  show(arrival: Arrival, sent: Header): void {
    if (!this.other) this.open(sent);
    this.own.show(arrival, sent);
  }

  close(): void {
    this.own.close();
    this.other?.source.close();
    this.other?.view.close();
  }

  private open(header: Header): void {
    const port = otherOf(header, this.host.about);
    if (port === undefined) return;
    const source = this.host.surroundings.open(port);
    const view = new ValuesView({ ...this.host, source }, this.range);
    this.other = { source, view };
    let sent: Header | undefined;
    source.on("header", (line) => (sent = sentHeader(line)));
    source.on("message", (arrival) => view.show(arrival, sent ?? arrival.message.header));
    if (header.coord === Coord.depth) this.element.append(view.element);
    else this.element.prepend(view.element);
  }
}

export const bothEyesView: ViewKind = {
  name: "both eyes",
  fits: (sent, about) => sent.scalar !== "u8" && otherOf(sent, about) !== undefined,
  make: (host) => new BothEyesView(host),
};
