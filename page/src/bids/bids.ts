// SPDX-License-Identifier: Apache-2.0
// Why a task has the focus, and the bids of the last seconds. Pure.
import type { Bid } from "../server";

/** The workspace's rules. */
export interface Rules {
  /** By which a challenger must exceed the bid in focus. */
  readonly margin: number;
  /** Minimum time that a task keeps the focus [s]. */
  readonly dwell: number;
  readonly stopped: boolean;
}

/** A sentence: which task has the focus, and why. @param nameOf  name of a mode. */
export function whyText(
  bids: readonly Bid[],
  rules: Rules,
  nameOf: (mode: number) => string,
): string {
  if (rules.stopped) return "The robot is stopped: no task has the focus.";
  const holder = bids.find((bid) => bid.inFocus);
  const others = bids.filter((bid) => bid !== holder).sort((a, b) => b.salience - a.salience);
  const next = others[0];
  if (!holder)
    return next
      ? `No task has the focus yet: ${nameOf(next.mode)} bids.`
      : "No task bids for the focus.";
  const name = nameOf(holder.mode);
  const bid = holder.salience.toFixed(2);
  if (holder.ofPerson) return `${name} has the focus: a person's bid overrides all others.`;
  if (!next) return `${name} has the focus as the only bidder, with ${bid}.`;
  const second = `${nameOf(next.mode)} with ${next.salience.toFixed(2)}`;
  if (next.salience <= holder.salience) {
    return `${name} has the focus: it bids ${bid}, next is ${second}.`;
  }
  return next.salience <= holder.salience + rules.margin
    ? `${name} keeps the focus with ${bid}: ${second} does not exceed it by more than ${rules.margin}.`
    : `${name} keeps the focus with ${bid} for its first ${rules.dwell} s; next is ${second}.`;
}

interface Sample {
  /** [s] */
  readonly time: number;
  readonly bids: readonly Bid[];
}

/** The bids of the last seconds. */
export class BidHistory {
  private samples: Sample[] = [];
  constructor(readonly seconds: number) {}

  /** A time before the last one, as after a jump in a recording, begins a new history. */
  add(time: number, bids: readonly Bid[]): void {
    if (time < (this.samples.at(-1)?.time ?? time)) this.samples = [];
    this.samples.push({ time, bids });
    const first = this.samples.findIndex((sample) => sample.time >= time - this.seconds);
    if (first > 0) this.samples.splice(0, first);
  }

  /** Saliences of a mode over time; 0 without a bid. */
  of(mode: number): { time: number; salience: number; inFocus: boolean }[] {
    return this.samples.map(({ time, bids }) => {
      const bid = bids.find((each) => each.mode === mode);
      return { time, salience: bid?.salience ?? 0, inFocus: bid?.inFocus ?? false };
    });
  }
}
