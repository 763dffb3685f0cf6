// SPDX-License-Identifier: Apache-2.0
// What was said of the last images, by their times. Pure.

const most = 30;
/** What is said of an image holds for others so near in time [ns]. */
const validity = 1_000_000_000n;

interface Timed {
  readonly time: bigint;
}

export class Recent<T extends Timed> {
  private readonly items: T[] = [];

  push(item: T): void {
    this.items.push(item);
    if (this.items.length > most) this.items.shift();
  }

  /** The item nearest to a time; undefined if none is near. */
  at(time: bigint): T | undefined {
    const away = (item: T): bigint => (item.time > time ? item.time - time : time - item.time);
    const nearest = this.items.reduce<T | undefined>(
      (best, item) => (best && away(best) < away(item) ? best : item),
      undefined,
    );
    return nearest && away(nearest) <= validity ? nearest : undefined;
  }

  clear(): void {
    this.items.length = 0;
  }
}
