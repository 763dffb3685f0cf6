// SPDX-License-Identifier: Apache-2.0
import { elementsOf, headerLine, infoOf, scalarBytes, scalarCount, type Message } from "../mtp";
import { Emitter, Signal, type Unsubscribe } from "../server";
import type { Source } from "../views";
import type { Track } from "./track";
import { expandZstd } from "./zstd";

const mostAtOnce = 500; // messages of one stream in one step
const pastOfPlots = 30; // [s], reread after a jump
const smallMessage = 4096; // [byte]

/** A stream of a recording, at its player's time. */
export class ReplaySource extends Emitter implements Source {
  readonly isReplay = true;
  private shown?: number; // index; -1: before the first
  private kind = "";
  private wanted = -Infinity; // time [s since 1970]
  private isBusy = false;

  constructor(
    private readonly track: Track,
    private readonly ended: (source: ReplaySource) => void,
  ) {
    super();
  }

  get port(): string {
    return this.track.port;
  }

  setWidth(): void {}

  override close(): void {
    super.close();
    this.ended(this);
  }

  /**
   * Emits the messages up to a time: the last large one, and all small ones since the previous time
   * or, after a jump, of the last half minute. While messages are shown, the newest time waits.
   */
  async goTo(time: number): Promise<void> {
    this.wanted = time;
    if (this.isBusy) return;
    this.isBusy = true;
    try {
      for (let last; (last = this.track.indexAt(this.wanted)) !== this.shown;)
        await this.showUpTo(last);
    } catch (error) {
      this.problems.set(error instanceof Error ? error.message : String(error));
    } finally {
      this.isBusy = false;
    }
  }

  private async showUpTo(last: number): Promise<void> {
    const before = this.shown ?? -1;
    this.shown = last;
    if (last < 0) {
      this.problems.set("The first message of this stream comes later.");
      return;
    }
    this.problems.set("");
    let first = last;
    if (this.track.usualBytes <= smallMessage) {
      const isJump = before < 0 || last < before || last - before > mostAtOnce;
      const from = isJump ? this.track.indexAt(this.track.timeAt(last) - pastOfPlots) : before;
      first = Math.max(from + 1, last - mostAtOnce + 1);
    }
    for (let index = first; index <= last; ++index) await this.show(index);
  }

  private async show(index: number): Promise<void> {
    const message = await expanded(await this.track.message(index));
    const { header } = message;
    const kind = `${header.info} ${header.coord} ${header.width} ${header.height}`;
    if (kind !== this.kind || index === this.shown) this.headers.set(headerLine(header));
    this.kind = kind;
    await this.give({ message, at: Date.now(), bytes: message.elements.byteLength });
  }
}

/** The message, with zstd elements expanded. */
async function expanded({ header, elements }: Message): Promise<Message> {
  if (header.encoding !== "zstd") return { header, elements };
  const size = scalarCount(header) * scalarBytes[header.scalar];
  const bytes = await expandZstd(elements as Uint8Array<ArrayBuffer>, size);
  const kind = { ...header, encoding: "binary" as const };
  return {
    header: { ...kind, info: infoOf(kind) },
    elements: elementsOf(header.scalar, bytes),
  };
}

/** Plays tracks with a common clock. */
export class Player {
  readonly begin: number; // [s since 1970]
  readonly end: number;
  private readonly sources = new Set<ReplaySource>();
  private readonly times = new Signal<number>();
  private readonly states = new Signal<boolean>(false);
  private speed = 1;
  private timer?: number;
  private tick = 0;

  constructor(readonly tracks: readonly Track[]) {
    const full = tracks.filter((track) => track.length > 0);
    this.begin = full.length === 0 ? 0 : Math.min(...full.map((track) => track.firstTime));
    this.end = full.length === 0 ? 0 : Math.max(...full.map((track) => track.lastTime));
    this.times.set(this.begin);
  }

  get time(): number {
    return this.times.value!;
  }

  get isPlaying(): boolean {
    return this.states.value === true;
  }

  onTime(listener: (time: number) => void): Unsubscribe {
    return this.times.on(listener);
  }

  onPlaying(listener: (isPlaying: boolean) => void): Unsubscribe {
    return this.states.on(listener);
  }

  /** The stream of a port; undefined if it was not recorded. */
  open(port: string): ReplaySource | undefined {
    const track = this.tracks.find((each) => each.port === port);
    if (!track) return undefined;
    const source = new ReplaySource(track, (each) => this.sources.delete(each));
    this.sources.add(source);
    queueMicrotask(() => void source.goTo(this.time));
    return source;
  }

  setSpeed(speed: number): void {
    this.speed = speed;
  }

  play(): void {
    if (this.isPlaying) return;
    if (this.time >= this.end) this.goTo(this.begin);
    this.states.set(true);
    this.tick = performance.now();
    this.timer = window.setInterval(() => this.step(), 16);
  }

  pause(): void {
    clearInterval(this.timer);
    if (this.isPlaying) this.states.set(false);
  }

  goTo(time: number): void {
    this.times.set(Math.min(this.end, Math.max(this.begin, time)));
    for (const source of this.sources) void source.goTo(this.time);
  }

  close(): void {
    this.pause();
    for (const source of [...this.sources]) source.close();
  }

  private step(): void {
    const now = performance.now();
    const seconds = Math.min(0.25, (now - this.tick) / 1000);
    this.tick = now;
    this.goTo(this.time + seconds * this.speed);
    if (this.time >= this.end) this.pause();
  }
}
