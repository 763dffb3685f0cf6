// SPDX-License-Identifier: Apache-2.0
// Motion-to-photon latency: from a command to the first displayed image that shows its effect.

/** One measurement; all times in ms. The parts add up to `total`. */
export interface Measurement {
  readonly total: number;
  /** From the command to the image's exposure. */
  readonly sensed: number;
  /** From there to the arrival at the page: exposure, encoder, network. */
  readonly arrived: number;
  readonly decoded: number;
  readonly drawn: number;
}

/** A displayed image; times in ms since the Unix epoch. */
export interface Shown {
  /** Grey values of a small version of it. */
  readonly thumbnail: Uint8Array;
  readonly sensed: number;
  readonly arrived: number;
  readonly decoded: number;
  readonly drawn: number;
}

/** Rest without commands before a measurement [ms]. */
const rest = 500;
/** Timeout of a measurement [ms]. */
const patience = 2000;
const most = 100;

/** Keeps the last 100 measurements, each of a command after some rest. */
export class Latency {
  readonly measurements: Measurement[] = [];
  private last?: Shown;
  /** The image before the command, and the image noise before it. */
  private pending?: { at: number; before: Shown; noise: number };
  private changes: number[] = [];
  private commanded = -Infinity;

  /** Notes a command that moves the head. @param at  [ms since the Unix epoch]. */
  command(at: number): void {
    const rested = at - this.commanded > rest;
    this.commanded = at;
    if (this.pending && at - this.pending.at > patience) this.pending = undefined;
    if (!rested || !this.last) return;
    this.pending = { at, before: this.last, noise: Math.max(0, ...this.changes) };
  }

  shown(image: Shown): void {
    const { pending, last } = this;
    this.last = image;
    if (!pending) {
      if (last) this.changes = [...this.changes, changeOf(last, image)].slice(-8);
      return;
    }
    if (image.sensed <= pending.at) return;
    if (changeOf(pending.before, image) <= 1.5 * pending.noise + 0.5) return;
    this.pending = undefined;
    this.changes = [];
    this.measurements.push({
      total: image.drawn - pending.at,
      sensed: image.sensed - pending.at,
      arrived: image.arrived - image.sensed,
      decoded: image.decoded - image.arrived,
      drawn: image.drawn - image.decoded,
    });
    if (this.measurements.length > most) this.measurements.shift();
  }

  /** Median of the totals [ms]. */
  get median(): number | undefined {
    return this.quantile(0.5);
  }

  get p99(): number | undefined {
    return this.quantile(0.99);
  }

  private quantile(part: number): number | undefined {
    const totals = this.measurements.map(({ total }) => total).sort((a, b) => a - b);
    return totals[Math.min(totals.length - 1, Math.floor(part * totals.length))];
  }
}

/** Mean difference of two images in grey values. */
function changeOf(a: Shown, b: Shown): number {
  const sum = a.thumbnail.reduce((total, value, i) => total + Math.abs(value - b.thumbnail[i]!), 0);
  return sum / Math.max(1, a.thumbnail.length);
}
