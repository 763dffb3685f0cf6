// SPDX-License-Identifier: Apache-2.0
import type { Arrival } from "../server";

const minutes = 10;

/**
 * The messages of the last ten minutes within a memory limit: beyond it, every second one of the
 * older half is dropped, so that the past becomes coarser, not shorter.
 */
export class Past {
  private entries: Arrival[] = [];
  private bytes = 0;

  /** @param mostBytes  of all messages. */
  constructor(private readonly mostBytes = 32 * 2 ** 20) {}

  get length(): number {
    return this.entries.length;
  }

  at(index: number): Arrival | undefined {
    return this.entries[index];
  }

  push(arrival: Arrival): void {
    this.entries.push(arrival);
    this.bytes += arrival.bytes;
    const oldest = arrival.at - minutes * 60_000;
    if (this.entries[0]!.at < oldest) this.keep((each) => each.at >= oldest);
    while (this.bytes > this.mostBytes && this.entries.length > 1) {
      const half = this.entries.length / 2;
      const before = this.entries.length;
      this.keep((_, index) => index >= half || index % 2 === 0);
      if (this.entries.length === before) this.keep((_, index) => index > 0);
    }
  }

  private keep(isKept: (arrival: Arrival, index: number) => boolean): void {
    this.entries = this.entries.filter(isKept);
    this.bytes = this.entries.reduce((sum, { bytes }) => sum + bytes, 0);
  }
}
