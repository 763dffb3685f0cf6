// SPDX-License-Identifier: Apache-2.0
// Draws the images of two eyes.
import type { Side } from "../views/pairing";
import type { Picture } from "./eye";
import { placesOf, type Place, type Way } from "./places";

export type Pictures = Readonly<Partial<Record<Side, Picture>>>;

const second = document.createElement("canvas");

/** Draws pictures into a canvas. */
export function drawPictures(canvas: HTMLCanvasElement, way: Way, pictures: Pictures): void {
  const context = canvas.getContext("2d");
  const image = (pictures.left ?? pictures.right)?.bitmap;
  if (!context || !image) return;
  context.globalCompositeOperation = "source-over";
  context.clearRect(0, 0, canvas.width, canvas.height);
  const places = placesOf(way, image, canvas);
  const { left, right } = pictures;
  if (way === "red/cyan" && left && right && places[0]) {
    const { x, y, width, height } = places[0];
    second.width = canvas.width;
    second.height = canvas.height;
    tint(context, left.bitmap, "#ff0000", places[0]);
    tint(second.getContext("2d")!, right.bitmap, "#00ffff", places[0]);
    context.globalCompositeOperation = "lighter";
    context.drawImage(second, x, y, width, height, x, y, width, height);
    return;
  }
  for (const { side, x, y, width, height } of places) {
    const picture = pictures[side] ?? (way === "red/cyan" ? left : undefined);
    if (picture) context.drawImage(picture.bitmap, x, y, width, height);
  }
}

function tint(
  context: CanvasRenderingContext2D,
  bitmap: ImageBitmap,
  colour: string,
  { x, y, width, height }: Place,
): void {
  context.globalCompositeOperation = "source-over";
  context.drawImage(bitmap, x, y, width, height);
  context.globalCompositeOperation = "multiply";
  context.fillStyle = colour;
  context.fillRect(x, y, width, height);
}

const small = document.createElement("canvas");
small.width = 32;
small.height = 24;
const smallContext = small.getContext("2d", { willReadFrequently: true });

/** Grey values of a small version of an image, 32 × 24. */
export function thumbnailOf(bitmap: ImageBitmap): Uint8Array {
  if (!smallContext) return new Uint8Array(0);
  smallContext.drawImage(bitmap, 0, 0, small.width, small.height);
  const { data } = smallContext.getImageData(0, 0, small.width, small.height);
  return Uint8Array.from({ length: data.length / 4 }, (_, i) => {
    const [r = 0, g = 0, b = 0] = data.subarray(4 * i, 4 * i + 3);
    return (r + 2 * g + b) / 4;
  });
}
