// SPDX-License-Identifier: Apache-2.0
// Makes measured values visible, as `hc view` does: in colours, as a relief, as fog. Pure.
import { turboPixels } from "./turbo";

export const codings = ["colours", "relief", "fog"] as const;
export type Coding = (typeof codings)[number];

/** A single-channel image, row by row. */
export interface Grid {
  readonly values: ArrayLike<number>;
  readonly width: number;
  /** 0 is unknown in some coordinate systems (R44). */
  readonly isZeroUnknown: boolean;
}

export type Range = readonly [least: number, most: number];

const palette = turboPixels();
const opaque = 0xff000000;
/** Of fog: its grey level, and its share at the far end of the range. */
const [greyOfFog, thickest] = [225, 0.9];
/** Stripes of two greys, which are not in the colours. */
export const stripes = [0xff101010, 0xff585858] as const;
/** What both eyes see alike, unlike stripes. */
export const black = [opaque, opaque] as const;

/** Whether a value is known. */
export function known(value: number, isZeroUnknown: boolean): boolean {
  return Number.isFinite(value) && !(isZeroUnknown && value === 0);
}

/** 2nd and 98th percentile of about 2000 samples of known values. */
export function usualRange({ values, isZeroUnknown }: Grid): Range | undefined {
  const step = Math.max(1, Math.floor(values.length / 2000));
  const samples: number[] = [];
  for (let i = 0; i < values.length; i += step) {
    if (known(values[i]!, isZeroUnknown)) samples.push(values[i]!);
  }
  if (samples.length === 0) return undefined;
  samples.sort((a, b) => a - b);
  const at = (part: number) => samples[Math.floor(part * (samples.length - 1))]!;
  return [at(0.02), at(0.98)];
}

/** A range that follows the values slowly, so that colours do not flicker. */
export class SlowRange {
  range?: Range;
  /** Keeps the range, once there is one. */
  isFixed = false;
  private time?: bigint;

  /**
   * @param time  of the values [ns]; both eyes of a time get one range. Undefined: any.
   * @returns  undefined until a value is known.
   */
  update(grid: Grid, time?: bigint): Range | undefined {
    if (this.isFixed && this.range) return this.range;
    const usual = time !== undefined && time === this.time ? undefined : usualRange(grid);
    if (usual) {
      const [least, most] = this.range ?? usual;
      const follow = (now: number, to: number) => now + 0.2 * (to - now);
      this.range = [follow(least, usual[0]), follow(most, usual[1])];
      this.time = time;
    }
    return this.range;
  }
}

/**
 * Writes the pixels of a canvas, ABGR in a number.
 *
 * @param holes  two colours for unknown values.
 * @param image  pixels of the same size; only for fog.
 * @returns  the number of unknown values.
 */
export function code(
  grid: Grid,
  range: Range | undefined,
  coding: Coding,
  holes: readonly [number, number],
  pixels: Uint32Array,
  image?: Uint32Array,
): number {
  const { values, width, isZeroUnknown } = grid;
  const [least, most] = range ?? [0, 1];
  const scale = 1 / (most > least ? most - least : 1);
  let unknown = 0;
  for (let i = 0, x = 0, y = 0; i < pixels.length; ++i) {
    const value = values[i]!;
    if (known(value, isZeroUnknown)) {
      const level = Math.min(1, Math.max(0, (value - least) * scale));
      if (coding === "fog") {
        const fog = thickest * level;
        pixels[i] = mixed(image?.[i] ?? opaque, 1 - fog, fog * greyOfFog);
      } else {
        const colour = palette[Math.round(255 * level)]!;
        pixels[i] = coding === "relief" ? mixed(colour, lightOf(grid, i, x, y), 0) : colour;
      }
    } else {
      ++unknown;
      pixels[i] = holes[((x + y) >> 2) & 1]!;
    }
    if (++x === width) {
      x = 0;
      ++y;
    }
  }
  return unknown;
}

/** Brightness of a relief lit from the top left: greater where values fall towards the light. */
function lightOf({ values, width, isZeroUnknown }: Grid, i: number, x: number, y: number): number {
  const steepness = 60;
  const here = values[i]!;
  const left = values[x > 0 ? i - 1 : i]!;
  const up = values[y > 0 ? i - width : i]!;
  if (!known(left, isZeroUnknown) || !known(up, isZeroUnknown)) return 1;
  // Relative, so that slopes look alike near and far.
  const rise = (left - here + (up - here)) / here;
  return Math.min(1.3, Math.max(0.35, 1 - steepness * rise));
}

/** A pixel whose red, green and blue are multiplied, and increased. */
function mixed(pixel: number, times: number, plus: number): number {
  const red = Math.min(255, Math.round((pixel & 255) * times + plus));
  const green = Math.min(255, Math.round(((pixel >>> 8) & 255) * times + plus));
  const blue = Math.min(255, Math.round(((pixel >>> 16) & 255) * times + plus));
  return (opaque | (blue << 16) | (green << 8) | red) >>> 0;
}
