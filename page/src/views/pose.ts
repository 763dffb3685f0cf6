// SPDX-License-Identifier: Apache-2.0
// A pose in words: its direction and its place. Pure.
import { Coord, numbersOf, type Message } from "../mtp";

export interface Pose {
  /** [°], to the left */
  readonly pan: number;
  /** [°], down */
  readonly tilt: number;
  /** [°], clockwise as seen from behind */
  readonly roll: number;
  /** Forward, left, up [m]; undefined for a rotation. */
  readonly place?: readonly [number, number, number];
}

const degrees = (angle: number) => (angle * 180) / Math.PI;

type Matrix = readonly (readonly [number, number, number])[];
/** To forward, left, up: of bodies, and of cameras, whose axes are right, down, forward (R44). */
const body: Matrix = [
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
];
const camera: Matrix = [
  [0, 0, 1],
  [-1, 0, 0],
  [0, -1, 0],
];

/** Undefined: a frame without a known number. */
function axesOf(coord: number): Matrix | undefined {
  if (coord === Coord.none || coord >= 100) return undefined;
  const isCamera = coord >= Coord.left_eye && coord <= Coord.disparity;
  return isCamera || coord === Coord.right_depth ? camera : body;
}

const dot = (a: readonly number[], b: readonly number[]) =>
  a.reduce((sum, each, i) => sum + each * b[i]!, 0);

/** The pose in a message; undefined: none. Of several rotations, the first. */
export function poseOf(message: Message): Pose | undefined {
  const { type, width, height, coord } = message.header;
  const numbers = numbersOf(message);
  if (type === "rotation" && numbers.length >= 3) {
    const [roll, tilt, pan] = [...numbers.subarray(0, 3)].map(degrees) as [number, number, number];
    return { pan, tilt, roll };
  }
  if (type !== "transformation" || width !== 4 || height !== 4) return undefined;
  const [given, sought] = [axesOf(coord % 1000), axesOf(Math.floor(coord / 1000))];
  const from = given ?? sought ?? body; // a frame without a number is like the other
  const to = sought ?? given ?? body;
  /** Turns a vector of the pose's own axes: forward, left or up. */
  const turned = (axis: readonly number[]) => {
    const there = [0, 1, 2].map((row) => dot(axis, [...numbers.subarray(4 * row, 4 * row + 3)]));
    return to.map((each) => dot(each, there));
  };
  const [forward, left, up] = from.map(turned) as [number[], number[], number[]];
  const origin = [3, 7, 11].map((at) => numbers[at]!);
  const [x, y, z] = to.map((each) => dot(each, origin)) as [number, number, number];
  return {
    pan: degrees(Math.atan2(forward[1]!, forward[0]!)),
    tilt: degrees(Math.asin(Math.max(-1, Math.min(1, -forward[2]!)))),
    roll: degrees(Math.atan2(left[2]!, up[2]!)),
    place: [x, y, z],
  };
}

/** "12.3° left"; "0.0°" without a direction. */
export function angleText(angle: number, positive: string, negative: string, digits = 1): string {
  const size = Math.abs(angle).toFixed(digits);
  if (Number(size) === 0) return `${size}°`;
  return `${size}° ${angle > 0 ? positive : negative}`;
}

/** "0.06 m forward, 0.05 m left"; "" at the origin. */
export function placeText(place: readonly [number, number, number]): string {
  const words = [
    ["forward", "back"],
    ["left", "right"],
    ["up", "down"],
  ] as const;
  return place
    .map((each, i) => ({ size: Math.abs(each).toFixed(2), word: words[i]![each > 0 ? 0 : 1] }))
    .filter(({ size }) => size !== "0.00")
    .map(({ size, word }) => `${size} m ${word}`)
    .join(", ");
}
