// SPDX-License-Identifier: Apache-2.0
import type { GraphLink, GraphState } from "../server";
import { linkKey } from "./structure";
import { droppedCount } from "./words";

/** How many messages each link drops a second, from its counters in one state and the next. */
export class DropRates {
  private before = new Map<string, number>();
  private rates = new Map<string, number>();
  private uptime = 0;

  /** Takes the next state; several within a fifth of a second count as one. */
  take(state: GraphState): void {
    const seconds = state.uptime - this.uptime;
    if (seconds >= 0 && seconds < 0.2) return;
    const now = new Map(state.links.map((link) => [linkKey(link), droppedCount(link)]));
    this.rates = new Map(
      [...now].map(([key, count]) => {
        const before = this.before.get(key) ?? count;
        // A module that was restarted counts from 0 again.
        return [key, seconds > 0 && count > before ? (count - before) / seconds : 0];
      }),
    );
    this.before = now;
    this.uptime = state.uptime;
  }

  /** [messages/s] */
  of(link: GraphLink): number {
    return this.rates.get(linkKey(link)) ?? 0;
  }
}
