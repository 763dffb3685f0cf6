// SPDX-License-Identifier: Apache-2.0
// Pairs the messages of two eyes by their times. Pure.

export type Side = "left" | "right";

interface Timed {
  readonly time: bigint;
}

/** Most items of an eye that wait for a partner. */
const mostKept = 4;

/**
 * Makes pairs of one time. After `mostKept` items without a partner, as a slow link drops different
 * times of each eye, items up to half a period apart are a pair; after twice as many, any nearest two.
 */
export class Pairing<T extends Timed> {
  private readonly waiting: Record<Side, T[]> = { left: [], right: [] };
  private readonly last: Partial<Record<Side, bigint>> = {}; // times
  private readonly periods: Partial<Record<Side, bigint>> = {};
  private alone = 0; // items in a row without one of their time

  /** @param drop  takes each item that is in no pair. */
  constructor(private readonly drop: (item: T) => void = () => {}) {}

  /** The pair that an item completes, newer than the last one. */
  take(side: Side, item: T): Readonly<Record<Side, T>> | undefined {
    const own = this.waiting[side];
    const others = this.waiting[side === "left" ? "right" : "left"];
    this.measure(side, item.time);
    const other = nearest(others, item.time);
    const away = other && distance(other.time, item.time);
    if (away !== 0n) ++this.alone;
    if (!other || away! > this.farthest()) {
      own.push(item);
      if (own.length > mostKept) this.drop(own.shift()!);
      return undefined;
    }
    this.alone = away === 0n ? 0 : mostKept;
    own.splice(0).forEach(this.drop);
    others.splice(0, others.indexOf(other)).forEach(this.drop);
    others.shift(); // the other one itself
    return side === "left" ? { left: item, right: other } : { left: other, right: item };
  }

  close(): void {
    for (const items of Object.values(this.waiting)) items.splice(0).forEach(this.drop);
  }

  private measure(side: Side, time: bigint): void {
    const last = this.last[side];
    if (last !== undefined && time > last) this.periods[side] = time - last;
    this.last[side] = time;
  }

  /** How far two items of a pair may be apart. */
  private farthest(): bigint | number {
    if (this.alone <= mostKept) return 0;
    const { left, right } = this.periods;
    if (this.alone > 2 * mostKept || !left || !right) return Infinity;
    return (left < right ? left : right) / 2n;
  }
}

const distance = (a: bigint, b: bigint): bigint => (a > b ? a - b : b - a);

function nearest<T extends Timed>(items: readonly T[], to: bigint): T | undefined {
  return items.reduce<T | undefined>(
    (best, item) => (best && distance(best.time, to) <= distance(item.time, to) ? best : item),
    undefined,
  );
}
