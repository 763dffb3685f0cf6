// SPDX-License-Identifier: Apache-2.0
// The rows of the modules that find faces and hands. Pure.
import { numbersOf, rowsOf, type Message } from "../mtp";

export interface Point {
  readonly x: number;
  readonly y: number;
}

/** A face in an image [px]. */
export interface Face extends Point {
  readonly width: number;
  readonly height: number;
  readonly track: number;
  /** Number of a known person; 0: unknown. */
  readonly person: number;
  /** Right and left eye, nose, mouth, right and left ear. */
  readonly points: readonly Point[];
}

/** A hand in an image [px]. */
export interface Hand {
  readonly track: number;
  readonly isRight: boolean;
  /** What it shows; empty: no sign. */
  readonly sign: string;
  /** The wrist, then of each finger, thumb first, its joints from the palm to the tip. */
  readonly points: readonly Point[];
}

/** The person at whom the robot looks. */
export interface Attended {
  readonly track: number;
  /** In words. */
  readonly reason: string;
}

const signs = ["", "open hand", "fist", "pointing", "victory", "thumb up"];
const reasons = ["nearest", "speaks", "held"];

/** The rows of a table with at least so many numbers, all finite. */
function rows(message: Message, columns: number): number[][] {
  const { type, width, height, components } = message.header;
  const across = width * components;
  if (type !== "table" || across < columns) return [];
  const numbers = numbersOf(message);
  const all = Array.from({ length: height }, (_, row) =>
    Array.from(numbers.subarray(row * across, row * across + columns)),
  );
  return all.filter((row) => row.length === columns && row.every(Number.isFinite));
}

/** Points from pairs of numbers. */
function points(numbers: readonly number[]): Point[] {
  return Array.from({ length: numbers.length / 2 }, (_, i) => ({
    x: numbers[2 * i]!,
    y: numbers[2 * i + 1]!,
  }));
}

export function facesOf(message: Message): Face[] {
  return rows(message, 19).map((row) => {
    const [x = 0, y = 0, width = 0, height = 0, , track = 0, person = 0] = row;
    return { x, y, width, height, track, person, points: points(row.slice(7)) };
  });
}

export function handsOf(message: Message): Hand[] {
  return rows(message, 46).map((row) => {
    const [track = 0, side = 0, , sign = 0] = row;
    return { track, isRight: side === 1, sign: signs[sign] ?? "", points: points(row.slice(4)) };
  });
}

export function attendedOf(message: Message): Attended | undefined {
  const [row] = rows(message, 3);
  return row && { track: row[0]!, reason: reasons[row[2]!] ?? "" };
}

/** The names of people by their numbers, from lines "PERSON NAME". */
export function namesOf(message: Message): Map<number, string> {
  const lines = rowsOf(message).flatMap((row) => row.split("\n"));
  return new Map(
    lines.flatMap((line) => {
      const [, person, name] = /^(\d+) (.+)$/.exec(line) ?? [];
      return name === undefined ? [] : [[Number(person), name] as const];
    }),
  );
}

/** Whether a text can be the name of a person (W12 of spec/page.md). */
export function isName(text: string): boolean {
  const { length } = new TextEncoder().encode(text);
  return length > 0 && length <= 64 && !/^\.|[\u0000-\u001f\u007f/]/.test(text);
}
