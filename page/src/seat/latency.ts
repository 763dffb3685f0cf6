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
  /** Between the last images. */
  private changes: number[] = [];
  private commanded = -Infinity;

  /** Notes a command that moves the head. @param at  [ms since the Unix epoch]. */
  command(at: number): void {
    const rested = at - this.commanded > rest;
    this.commanded = at;
    if (!rested || !this.last) return;
    // The median is that of the head at rest, also if the first of them still show it moving.
    this.pending = { at, before: this.last, noise: quantile(this.changes, 0.5) ?? 0 };
  }

  shown(image: Shown): void {
    const { pending, last } = this;
    this.last = image;
    if (last) this.changes = [...this.changes, changeOf(last, image)].slice(-8);
    if (!pending || image.sensed <= pending.at) return;
    const total = image.drawn - pending.at;
    const isDifferent = changeOf(pending.before, image) > 1.5 * pending.noise + 0.5;
    if (isDifferent || total > patience) this.pending = undefined;
    if (!isDifferent || total > patience) return;
    this.measurements.push({
      total,
      sensed: image.sensed - pending.at,
      arrived: image.arrived - image.sensed,
      decoded: image.decoded - image.arrived,
      drawn: image.drawn - image.decoded,
    });
    if (this.measurements.length > most) this.measurements.shift();
  }

  /** Median of the totals [ms]. */
  get median(): number | undefined {
    return quantile(this.totals, 0.5);
  }

  get p99(): number | undefined {
    return quantile(this.totals, 0.99);
  }

  private get totals(): number[] {
    return this.measurements.map(({ total }) => total);
  }
}

function quantile(values: readonly number[], part: number): number | undefined {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))];
}

/** Mean difference of two images in grey values. */
function changeOf(a: Shown, b: Shown): number {
  const sum = a.thumbnail.reduce((total, value, i) => total + Math.abs(value - b.thumbnail[i]!), 0);
  return sum / Math.max(1, a.thumbnail.length);
}
