// SPDX-License-Identifier: Apache-2.0
// A stream with its header, shown by its type.
import { sentHeader, type Header } from "../mtp";
import type { Output } from "../outputs";
import type { Arrival } from "../server";
import { h } from "../shell/h";
import { HeaderStrip } from "./header_strip";
import { kindsFor } from "./kinds";
import { Past } from "./past";
import { isVideo } from "./picture";
import { Sight } from "./room";
import type { About, Source, Surroundings, View, ViewKind } from "./view";

export interface StreamViewHost {
  readonly surroundings: Surroundings;
  say(sentence: string): void;
  /** Called when the person chooses another view. */
  chosen?(view: string): void;
  /** Place for controls. */
  readonly tools: HTMLElement;
}

const snapshotPeriod = 500; // [ms]

export class StreamView {
  readonly element: HTMLElement;
  private readonly strip = new HeaderStrip();
  private readonly body = h(
    "div.stream-body.stack",
    h("p.waiting.muted", "Waiting for the first message…"),
  );
  private readonly problem = h("p.problem", { role: "status", hidden: true });
  private readonly choice = h("select", { "aria-label": "Shown as", hidden: true });
  private readonly pause = h("button", { "aria-pressed": "false" }, "Pause");
  private readonly viewTools = h("span.view-tools");
  private readonly slider = h("input", {
    type: "range",
    min: 0,
    step: 1,
    "aria-label": "Scroll back",
  });
  private readonly ago = h("span.ago.mono");
  private readonly scroll = h("div.scroll-back.row", { hidden: true }, [this.slider, this.ago]);
  private readonly sight: Sight;
  private readonly timer: number;
  private readonly past = new Past();
  private view?: View;
  private kind?: ViewKind;
  private making?: Promise<void>;
  private about: About = { columns: [], outputs: [] };
  private sent?: Header;
  private isPaused = false;
  private held: (() => void)[] = [];
  private lastSnapshot = 0;
  private last?: Arrival;

  /** @param wanted  name of the view, if it fits; empty: the default. */
  constructor(
    private readonly source: Source,
    private readonly host: StreamViewHost,
    private wanted = "",
  ) {
    this.element = h("div.stream-view.stack", [
      this.problem,
      this.body,
      this.scroll,
      this.strip.element,
    ]);
    this.sight = new Sight(this.element);
    host.tools.append(this.viewTools, this.choice);
    if (!source.isReplay) host.tools.append(this.pause);
    this.pause.onclick = () => this.setPaused(!this.isPaused);
    this.choice.onchange = () => {
      this.wanted = this.choice.value;
      host.chosen?.(this.wanted);
      if (this.sent) void this.choose(this.sent).then(() => this.showAgain());
    };
    this.slider.oninput = () => this.showPast();
    source.on("header", (line) => this.setHeader(line));
    source.on("problem", (text) => {
      this.problem.hidden = text === "";
      this.problem.textContent = text;
    });
    source.on("message", (arrival) => this.receive(arrival));
    this.timer = window.setInterval(() => this.strip.draw(), 1000);
    void host.surroundings.outputsBeside(source.port).then((outputs) => this.describe(outputs));
  }

  close(): void {
    clearInterval(this.timer);
    this.sight.close();
    this.release();
    this.source.close();
    this.view?.close?.();
  }

  private setHeader(line: string): void {
    this.strip.setLine(line);
    this.sent = sentHeader(line) ?? this.sent;
  }

  /** Takes the description, which may come later than the first message. */
  private describe(outputs: readonly Output[]): void {
    const own = outputs.find(({ port }) => port === this.source.port);
    if (!own) return;
    this.strip.setDoc(own.doc);
    this.about = { columns: own.columns, outputs };
    this.kind = undefined;
    if (this.sent) void this.choose(this.sent).then(() => this.showAgain());
  }

  private async receive(arrival: Arrival): Promise<void> {
    const sent = this.sent ?? arrival.message.header;
    this.last = arrival;
    this.strip.count(arrival, sent, this.source.isReplay);
    await this.choose(sent);
    const { view } = this;
    if (!view) return;
    if (view.keepsPast) {
      await view.show(arrival, sent);
      return;
    }
    // The server waits until this message is processed, then sends the newest, of video a key frame.
    if (this.isPaused) await new Promise<void>((resolve) => this.held.push(resolve));
    if (!isVideo(arrival.message, sent)) this.past.push(arrival);
    if (!view.runsUnseen) await this.sight.seen();
    await this.view?.show(arrival, sent); // may have changed meanwhile
    if (isVideo(arrival.message, sent)) void this.keepSnapshot(arrival.at);
  }

  /** Keeps a snapshot, in parallel with the stream, since browsers encode when idle. */
  private async keepSnapshot(now: number): Promise<void> {
    if (now < this.lastSnapshot + snapshotPeriod) return;
    this.lastSnapshot = Infinity; // until this one is finished
    const snapshot = await this.view?.snapshot?.();
    this.lastSnapshot = now;
    if (snapshot) this.past.push(snapshot);
  }

  /** Creates the matching view, if it has changed. */
  private async choose(sent: Header): Promise<void> {
    await this.making;
    const fitting = kindsFor(sent, this.about);
    const kind = fitting.find(({ name }) => name === this.wanted) ?? fitting[0];
    if (kind === this.kind || !kind) return;
    this.kind = kind;
    this.choice.hidden = fitting.length < 2;
    this.choice.replaceChildren(
      ...fitting.map(({ name }) =>
        h("option", { value: name, selected: name === kind.name }, name),
      ),
    );
    this.making = this.make(kind);
    await this.making;
  }

  private async make(kind: ViewKind): Promise<void> {
    this.view?.close?.();
    const { source, host, about } = this;
    const { surroundings } = host;
    const view = await kind.make({
      source,
      surroundings,
      about,
      say: (text) => host.say(text),
    });
    this.view = view;
    this.body.replaceChildren(view.element);
    this.viewTools.replaceChildren(...(view.tools ?? []));
    view.setPaused?.(this.isPaused);
  }

  private release(): void {
    for (const resolve of this.held.splice(0)) resolve();
  }

  private async showAgain(): Promise<void> {
    if (this.last && this.sent) await this.view?.show(this.last, this.sent);
  }

  private setPaused(paused: boolean): void {
    this.isPaused = paused;
    this.pause.setAttribute("aria-pressed", String(paused));
    this.pause.textContent = paused ? "Resume" : "Pause";
    if (!paused) this.release();
    this.view?.setPaused?.(paused);
    this.scroll.hidden = !paused || this.view?.keepsPast === true || this.past.length < 2;
    this.slider.max = String(this.past.length - 1);
    this.slider.value = this.slider.max;
    this.ago.textContent = "now";
  }

  private showPast(): void {
    const arrival = this.past.at(Number(this.slider.value));
    const newest = this.past.at(this.past.length - 1);
    if (!arrival || !newest || !this.sent) return;
    const seconds = (arrival.at - newest.at) / 1000;
    this.ago.textContent = `${seconds.toFixed(1)} s`;
    this.slider.setAttribute("aria-valuetext", `${-seconds.toFixed(1)} seconds ago`);
    const { type } = arrival.message.header;
    void this.view?.show(arrival, { ...this.sent, type });
  }
}
