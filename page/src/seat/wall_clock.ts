// SPDX-License-Identifier: Apache-2.0
// Wall time with a finer resolution than the millisecond of Date.now().

/** A larger difference of the clocks means that the machine slept or its clock was set [ms]. */
const stepped = 5;

/** Wall time from a fine clock, which may stop while the machine sleeps, corrected by a coarse clock. */
export class WallClock {
  private offset: number;

  constructor(
    private readonly fine = () => performance.now(),
    private readonly wall = () => Date.now(),
  ) {
    this.offset = this.wall() - this.fine();
  }

  /** [ms since the Unix epoch], with a fraction. */
  now(): number {
    const wall = this.wall();
    const time = this.fine() + this.offset;
    if (Math.abs(time - wall) <= stepped) return time;
    this.offset = wall - this.fine();
    return wall;
  }
}
