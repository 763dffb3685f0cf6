// SPDX-License-Identifier: Apache-2.0
import type { GraphLink, GraphState } from "../server";
import { linkKey } from "./structure";
import { droppedCount } from "./words";

/** Each link's drops per second, from its counters in consecutive states. */
export class DropRates {
  private before = new Map<string, number>();
  private rates = new Map<string, number>();
  private uptime = 0;

  /** Takes the next state; states within 0.2 s count as one. */
  take(state: GraphState): void {
    const seconds = state.uptime - this.uptime;
    if (seconds >= 0 && seconds < 0.2) return;
    const now = new Map(state.links.map((link) => [linkKey(link), droppedCount(link)]));
    this.rates = new Map(
      [...now].map(([key, count]) => {
        const before = this.before.get(key) ?? count;
        // A restarted module counts from 0.
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
