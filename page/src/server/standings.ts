// SPDX-License-Identifier: Apache-2.0
// The bids for the focus.
import { numbersOf, type Message } from "../mtp";
import { Signal, type Unsubscribe } from "./signal";
import { Stream } from "./stream";
import type { GraphState } from "./types";

const rate = 10; // [Hz]

/** A row of a workspace's `standings`. */
export interface Bid {
  readonly mode: number;
  /** 0 … 1 */
  readonly salience: number;
  /** [s] */
  readonly age: number;
  readonly inFocus: boolean;
  /** Made by a person; overrides all others. */
  readonly ofPerson: boolean;
}

/** The bids in a message of `standings`: rows of mode, salience, age, in focus, a person's. */
export function bidsOf(message: Message): Bid[] {
  const numbers = numbersOf(message);
  const columns = message.header.width * message.header.components;
  if (columns < 5) return [];
  return Array.from({ length: message.header.height }, (_, row) => {
    const [mode = 0, salience = 0, age = 0, inFocus = 0, ofPerson = 0] = numbers.subarray(
      row * columns,
      row * columns + 5,
    );
    return { mode, salience, age, inFocus: inFocus !== 0, ofPerson: ofPerson !== 0 };
  });
}

/** Bids that have arrived. */
export interface Standing {
  readonly workspace: string;
  readonly bids: readonly Bid[];
  /** [ms since 1970] */
  readonly at: number;
}

/** The newest bids of each workspace of a graph. */
export class Standings {
  private readonly streams = new Map<string, Stream>();
  private readonly newest = new Map<string, readonly Bid[]>();
  private readonly arrivals = new Signal<Standing>();

  /** Calls a listener with all new bids. */
  on(listener: (standing: Standing) => void): Unsubscribe {
    return this.arrivals.on(listener);
  }

  /** The newest bids of a workspace; none without a connection. */
  of(workspace: string): readonly Bid[] {
    return this.newest.get(workspace) ?? [];
  }

  /** Follows the workspaces of a state, which may change. */
  follow({ focus }: GraphState): void {
    for (const [workspace, stream] of this.streams) {
      if (workspace in focus) continue;
      stream.close();
      this.streams.delete(workspace);
      this.newest.delete(workspace);
    }
    for (const workspace of Object.keys(focus)) {
      if (!this.streams.has(workspace)) this.streams.set(workspace, this.open(workspace));
    }
  }

  /** Forgets the bids, because the connection is lost. */
  clear(): void {
    this.newest.clear();
  }

  private open(workspace: string): Stream {
    const stream = new Stream(`${workspace}.standings`, { rate });
    stream.on("message", ({ message, at }) => {
      const bids = bidsOf(message);
      this.newest.set(workspace, bids);
      this.arrivals.emit({ workspace, bids, at });
    });
    return stream;
  }
}
