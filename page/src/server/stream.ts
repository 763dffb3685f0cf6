// SPDX-License-Identifier: Apache-2.0
import { MtpError, readMessage, type Message } from "../mtp";
import { Signal, type Unsubscribe } from "./signal";
import { Socket } from "./socket";

/** How a stream is sent (W9). */
export interface StreamOptions {
  as?: "raw" | "jpeg" | "vp8";
  /** Maximum elements in a row. */
  width?: number;
  /** Maximum rate [Hz]. */
  rate?: number;
}

/** A message and its arrival [ms since the Unix epoch]. */
export interface Arrival {
  readonly message: Message;
  readonly at: number;
  readonly bytes: number;
}

/** Passes the messages of an output to listeners. */
export class Emitter {
  protected readonly headers = new Signal<string>();
  protected readonly problems = new Signal<string>();
  private readonly consumers = new Set<(arrival: Arrival) => void | Promise<void>>();

  /** Each message; the next one follows when the promises of all listeners are settled. */
  on(event: "message", listener: (arrival: Arrival) => void | Promise<void>): Unsubscribe;
  /** The original header line, before scaling and encoding (W10). */
  on(event: "header", listener: (line: string) => void): Unsubscribe;
  /** A sentence on a problem; empty: none. */
  on(event: "problem", listener: (problem: string) => void): Unsubscribe;
  on(
    event: "message" | "header" | "problem",
    listener: ((arrival: Arrival) => void | Promise<void>) | ((text: string) => void),
  ): Unsubscribe {
    if (event === "header") return this.headers.on(listener as (line: string) => void);
    if (event === "problem") return this.problems.on(listener as (problem: string) => void);
    const consumer = listener as (arrival: Arrival) => void | Promise<void>;
    this.consumers.add(consumer);
    return () => this.consumers.delete(consumer);
  }

  close(): void {
    this.consumers.clear();
  }

  protected async give(arrival: Arrival): Promise<void> {
    await Promise.all([...this.consumers].map((consumer) => consumer(arrival)));
  }
}

/**
 * The newest messages of an output: a promise returned by a listener pauses the stream.
 */
export class Stream extends Emitter {
  private readonly socket: Socket;
  private askedWidth?: number; // with the path

  constructor(
    readonly port: string,
    private options: StreamOptions = {},
  ) {
    super();
    this.socket = new Socket(() => this.path(), {
      open: () => this.opened(),
      text: (text) => this.headers.set(text.trimEnd()),
      binary: (bytes) => void this.receive(bytes),
      lost: (code, reason, retry) => this.problems.set(problemOf(port, code, reason, retry)),
    });
  }

  /** The last original header line. */
  get header(): string | undefined {
    return this.headers.value;
  }

  setWidth(width: number): void {
    if (width === this.options.width) return;
    this.options = { ...this.options, width };
    this.socket.send(`width=${width}`);
  }

  /** Restarts with the last message; video restarts with a key frame. */
  restart(): void {
    this.socket.reopen();
  }

  override close(): void {
    this.socket.close();
    super.close();
  }

  private path(): string {
    this.askedWidth = this.options.width;
    const query = Object.entries(this.options)
      .filter(([, value]) => value !== undefined)
      .map(([key, value]) => `${key}=${value}`)
      .join("&");
    return `/streams/${this.port}${query && "?" + query}`;
  }

  private opened(): void {
    this.problems.set("");
    const { width } = this.options;
    if (width !== this.askedWidth) this.socket.send(`width=${width}`);
  }

  private async receive(bytes: Uint8Array<ArrayBuffer>): Promise<void> {
    const at = Date.now();
    try {
      await this.give({ message: readMessage(bytes), at, bytes: bytes.length });
    } catch (error) {
      if (!(error instanceof MtpError)) console.error(error);
      this.problems.set(`${this.port}: ${error instanceof Error ? error.message : String(error)}`);
    } finally {
      this.socket.send("ok");
    }
  }
}

function problemOf(port: string, code: number, reason: string, retry: number | null): string {
  if (code === 4404) return reason || `There is no output ${port}.`;
  if (code === 1000) return "The graph has ended.";
  return retry === null
    ? `The server closed this stream: ${reason || `code ${code}`}.`
    : "The stream is interrupted; reconnecting.";
}
