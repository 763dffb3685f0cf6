// SPDX-License-Identifier: Apache-2.0
// Places for the labels of lines, where none covers another one or a box. Pure, deterministic.

/** [px] of the drawing, from its top left corner. */
export interface Point {
  readonly x: number;
  readonly y: number;
}

/** Where a text is: its baseline begins or ends there. */
export interface Label extends Point {
  readonly anchor: "start" | "end";
}

export interface Area {
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
}

/** The letters that a label has room for, such as "100/s 154 ms". */
export const labelLetters = 12;
/** Of so many of the widest, with digits of DejaVu Sans, in the size of `.edge-words` [px]. */
const labelWidth = 75;
/** Above and below the baseline [px]. */
const [ascent, descent] = [10.5, 2.5];
/** Between a label and the end of its line, whose arrow head is longer [px]. */
const [fromStart, fromEnd] = [5, 10];
/** The baseline over or under its line [px]. */
const heights = [-3, 11.5];

/** The area that a label may fill. */
export function areaOf({ x, y, anchor }: Label): Area {
  const left = anchor === "start" ? x : x - labelWidth;
  return { left, top: y - ascent, right: left + labelWidth, bottom: y + descent };
}

export function overlap(a: Area, b: Area): boolean {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

/**
 * Places the labels of lines, at their starts if possible.
 *
 * @param lines  by key, horizontal at their points. Those with the fewest places choose first.
 * @returns  by key; a line without room has none.
 */
export function placeLabels(
  lines: ReadonlyMap<string, readonly Point[]>,
  boxes: readonly Area[],
): Map<string, Label> {
  const taken = [...boxes];
  const labels = new Map<string, Label>();
  const waiting = [...lines].map(([key, points]) => ({ key, places: placesAlong(points) }));
  // A line that could have its label elsewhere leaves its start to those that could not.
  waiting.sort((a, b) => a.places.length - b.places.length);
  const most = Math.max(0, ...waiting.map(({ places }) => places.length));
  for (let round = 0; round < most; ++round) {
    for (const { key, places } of waiting) {
      const label = places[round];
      if (!label || labels.has(key)) continue;
      const area = areaOf(label);
      if (taken.some((each) => overlap(each, area))) continue;
      taken.push(area);
      labels.set(key, label);
    }
  }
  return labels;
}

/**
 * Places beside a line, the best first: over its horizontal parts, which are at its ends and where it
 * passes columns, then under them, then beside its bends.
 */
function placesAlong(points: readonly Point[]): Label[] {
  const last = points.length - 1;
  const straight = heights.flatMap((height) =>
    points.map((point, i): Label => {
      // Points 1 and 2, 3 and 4 and so on are the ends of a part across a column.
      const other = i === 0 || (i % 2 === 1 && i < last) ? points[i + 1]! : points[i - 1]!;
      const gap = i === last ? fromEnd : fromStart;
      return other.x < point.x
        ? { x: point.x - gap, y: point.y + height, anchor: "end" }
        : { x: point.x + gap, y: point.y + height, anchor: "start" };
    }),
  );
  const bends = points.slice(1).flatMap((point, i) =>
    [0.5, 0.25, 0.75].flatMap((t): Label[] => {
      const { x, y } = bendAt(points[i]!, point, t);
      return [
        { x: x + fromStart, y: y + 4, anchor: "start" },
        { x: x - fromStart, y: y + 4, anchor: "end" },
      ];
    }),
  );
  return [...straight, ...bends];
}

/** The controls of the cubic curve from one point of a line to the next, horizontal at both. */
function controls(before: Point, point: Point): [number, number] {
  const isBeside = Math.abs(before.x - point.x) < 20; // in the same column
  const out = isBeside ? 40 : (point.x - before.x) / 2;
  return [before.x + out, isBeside ? point.x + 40 : point.x - out];
}

function bendAt(before: Point, point: Point, t: number): Point {
  const along = (a: number, b: number, c: number, d: number): number =>
    (1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t ** 2 * c + t ** 3 * d;
  const [out, back] = controls(before, point);
  return {
    x: along(before.x, out, back, point.x),
    y: along(before.y, before.y, point.y, point.y),
  };
}

/** A path through points, horizontal at each of them, as the `d` of an SVG path. */
export function pathThrough(points: readonly Point[]): string {
  const at = (x: number, y: number): string => `${x.toFixed(1)} ${y.toFixed(1)}`;
  return points.reduce((path, point, i) => {
    const before = points[i - 1];
    if (!before) return `M${at(point.x, point.y)}`;
    if (before.y === point.y) return `${path}L${at(point.x, point.y)}`;
    const [out, back] = controls(before, point);
    return `${path}C${at(out, before.y)} ${at(back, point.y)} ${at(point.x, point.y)}`;
  }, "");
}
