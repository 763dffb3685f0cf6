// SPDX-License-Identifier: Apache-2.0
import type { GraphState, Server, Stream } from "../server";
import { bidsOf, type Bid } from "./bids";

/** The newest bids of each workspace of a graph. */
export class Standings {
  private readonly streams = new Map<string, Stream>();
  private readonly bids = new Map<string, readonly Bid[]>();

  /**
   * @param rate  at most so many messages a second.
   * @param onBids  called with each message; `at`: its arrival [ms].
   */
  constructor(
    private readonly server: Server,
    private readonly rate: number,
    private readonly onBids: (workspace: string, bids: readonly Bid[], at: number) => void,
  ) {}

  /** Follows the workspaces of a state, which may change. */
  follow(state: GraphState): void {
    for (const [name, stream] of this.streams) {
      if (name in state.focus) continue;
      stream.close();
      this.streams.delete(name);
      this.bids.delete(name);
    }
    for (const name of Object.keys(state.focus)) {
      if (this.streams.has(name)) continue;
      const stream = this.server.stream(`${name}.standings`, { rate: this.rate });
      stream.on("message", ({ message, at }) => {
        const bids = bidsOf(message);
        this.bids.set(name, bids);
        this.onBids(name, bids, at);
      });
      this.streams.set(name, stream);
    }
  }

  /** The newest bids of a workspace. */
  of(workspace: string): readonly Bid[] {
    return this.bids.get(workspace) ?? [];
  }

  close(): void {
    for (const stream of this.streams.values()) stream.close();
  }
}
