// SPDX-License-Identifier: Apache-2.0

/**
 * Numbers of the last ten minutes: columns that grow to a limit, then drop their oldest quarter.
 */
export class Series {
  private times = new Float64Array(1024); // [s since 1970]
  private columns: Float64Array[];
  private count = 0;

  /**
   * @param width  numbers at a time.
   * @param most  maximum number of times.
   */
  constructor(
    readonly width: number,
    private readonly most = 120_000,
  ) {
    this.columns = Array.from({ length: width }, () => new Float64Array(1024));
  }

  get length(): number {
    return this.count;
  }

  get firstTime(): number {
    return this.times[0]!;
  }

  get lastTime(): number {
    return this.times[this.count - 1]!;
  }

  /** Adds numbers; drops ones out of order, and old ones after ten minutes. */
  push(time: number, numbers: ArrayLike<number>): void {
    if (this.count > 0 && time <= this.lastTime) {
      if (time > this.lastTime - 1) return;
      this.count = 0; // the source has restarted
    }
    if (this.count === this.times.length) this.makeRoom();
    this.times[this.count] = time;
    this.columns.forEach((column, i) => (column[this.count] = numbers[i]!));
    this.count += 1;
  }

  /** The times from `from` to `to` [s] and one more on each side, with their columns. */
  window(from: number, to: number, columns: readonly number[]): Float64Array[] {
    const first = Math.max(0, this.indexOf(from) - 1);
    const last = Math.min(this.count, this.indexOf(to) + 1);
    const shown = [this.times, ...columns.map((which) => this.columns[which]!)];
    return shown.map((column) => column.slice(first, last));
  }

  /** Index of the first time not before `time`. */
  private indexOf(time: number): number {
    let [low, high] = [0, this.count];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times[middle]! < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  private makeRoom(): void {
    const old = this.lastTime - 600;
    const isFull = 2 * this.count > this.most;
    const drop = Math.max(this.indexOf(old), isFull ? Math.floor(this.count / 4) : 0);
    if (drop > this.count / 8) {
      for (const column of [this.times, ...this.columns]) column.copyWithin(0, drop, this.count);
      this.count -= drop;
      return;
    }
    const grown = (from: Float64Array) => {
      const to = new Float64Array(2 * from.length);
      to.set(from);
      return to;
    };
    this.times = grown(this.times);
    this.columns = this.columns.map(grown);
  }
}
