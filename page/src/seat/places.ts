// SPDX-License-Identifier: Apache-2.0
// The layout of two eyes' images in a canvas, in several ways. Pure.
import type { Side } from "../views/pairing";

export const ways = ["left", "right", "side by side", "red/cyan"] as const;
export type Way = (typeof ways)[number];
/** Their names for a person. */
export const wayNames: Record<Way, string> = {
  left: "Left eye",
  right: "Right eye",
  "side by side": "Both, side by side",
  "red/cyan": "Both, red/cyan",
};

/** A part of a canvas that shows an eye [px]. */
export interface Place {
  readonly side: Side;
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
}

/** The eyes that a way needs. */
export function sidesOf(way: Way): readonly Side[] {
  if (way === "left" || way === "right") return [way];
  return ["left", "right"];
}

/** Positions of the eyes in a canvas: centred, as large as possible. */
export function placesOf(
  way: Way,
  image: { width: number; height: number },
  canvas: { width: number; height: number },
): Place[] {
  const across = way === "side by side" ? 2 : 1;
  const scale = Math.min(canvas.width / (across * image.width), canvas.height / image.height);
  const width = image.width * scale;
  const height = image.height * scale;
  const x = (canvas.width - across * width) / 2;
  const y = (canvas.height - height) / 2;
  const sides = way === "red/cyan" ? (["left"] as const) : sidesOf(way);
  return sides.map((side, i) => ({ side, x: x + i * width, y, width, height }));
}

/** The sensor pixel of an eye at a point of the canvas; undefined outside the images. */
export function pixelAt(
  places: readonly Place[],
  point: { x: number; y: number },
  sensor: { width: number; height: number },
): { side: Side; x: number; y: number } | undefined {
  const place = places.find(
    ({ x, y, width, height }) =>
      point.x >= x && point.x < x + width && point.y >= y && point.y < y + height,
  );
  if (!place) return undefined;
  // The origin is the centre of the first pixel.
  const x = ((point.x - place.x) / place.width) * sensor.width - 0.5;
  const y = ((point.y - place.y) / place.height) * sensor.height - 0.5;
  return { side: place.side, x, y };
}
