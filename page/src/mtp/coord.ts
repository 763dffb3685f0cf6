// SPDX-License-Identifier: Apache-2.0

/** Coordinate systems that have a name (R44). */
export const Coord = {
  none: 0,
  world: 1,
  robot: 2,
  head: 3,
  left_eye: 4,
  right_eye: 5,
  cyclopean_eye: 6,
  left_image: 7,
  right_image: 8,
  left_rectified: 9,
  right_rectified: 10,
  depth: 11,
  disparity: 12,
  gaze: 13,
  supervisor: 14,
  right_depth: 15,
  sound_8k: 20,
  sound_16k: 21,
  sound_22k: 22,
  sound_44k: 23,
  sound_48k: 24,
  text: 30,
  order: 40,
} as const;

const names = new Map<number, string>(
  Object.entries(Coord).map(([name, number]) => [number, name]),
);

/** Name of a coordinate system, of a transformation "from to to"; else its number. */
export function coordName(coord: number): string {
  if (coord >= 1000) {
    return `${coordName(coord % 1000)} to ${coordName(Math.floor(coord / 1000))}`;
  }
  return names.get(coord) ?? String(coord);
}

/** Sample rate of sound in a coordinate system [Hz]; 16000 if not specified. */
export function sampleRate(coord: number): number {
  return { 20: 8000, 21: 16000, 22: 22050, 23: 44100, 24: 48000 }[coord] ?? 16000;
}
