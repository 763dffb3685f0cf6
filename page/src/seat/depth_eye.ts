// SPDX-License-Identifier: Apache-2.0
// Makes an eye's depth visible; for fog also with the eye's images.
import { numbersOf, type Message } from "../mtp";
import type { Server, Stream } from "../server";
import { black, code } from "../views/coding";
import { bitmapOf } from "../views/picture";
import type { DepthOptions } from "./eye";

/** Images that wait for their depth, which comes later by the time of matching. */
const mostKept = 8;

interface Kept {
  readonly time: bigint;
  readonly bitmap: ImageBitmap;
}

export class DepthEye {
  private readonly images?: Stream;
  private readonly context = document.createElement("canvas").getContext("2d", {
    willReadFrequently: true,
  })!;
  private kept: Kept[] = [];
  private closed = false;

  constructor(
    server: Server,
    width: number,
    private readonly options: DepthOptions,
    problem: (text: string) => void,
  ) {
    if (options.coding !== "fog" || !options.image) return;
    this.images = server.stream(options.image, { as: "jpeg", width });
    this.images.on("message", ({ message }) => this.keep(message));
    this.images.on("problem", problem);
  }

  setWidth(width: number): void {
    this.images?.setWidth(width);
  }

  close(): void {
    this.closed = true;
    this.images?.close();
    for (const { bitmap } of this.kept.splice(0)) bitmap.close();
  }

  /** Undefined if the depth is empty, or in fog no image has come yet. */
  async bitmapOf(message: Message): Promise<ImageBitmap | undefined> {
    const { width, height, time } = message.header;
    if (width === 0 || height === 0) return undefined;
    const { coding, range } = this.options;
    const image = coding === "fog" ? this.imageAt(time, width, height) : undefined;
    if (coding === "fog" && !image) return undefined;
    const grid = { values: numbersOf(message), width, isZeroUnknown: true };
    const data = new ImageData(width, height);
    const pixels = new Uint32Array(data.data.buffer);
    code(grid, range.update(grid, time), coding, black, pixels, image);
    return createImageBitmap(data);
  }

  private async keep(message: Message): Promise<void> {
    const bitmap = await bitmapOf(message);
    if (!bitmap || this.closed) return bitmap?.close();
    this.kept.push({ time: message.header.time, bitmap });
    if (this.kept.length > mostKept) this.kept.shift()!.bitmap.close();
  }

  /** The pixels of the image that is nearest in time: a slow link drops images and depths. */
  private imageAt(time: bigint, width: number, height: number): Uint32Array | undefined {
    const away = (kept: Kept) => Math.abs(Number(kept.time - time));
    const [first, ...others] = this.kept;
    if (!first) return undefined;
    const nearest = others.reduce((best, each) => (away(each) < away(best) ? each : best), first);
    const { context } = this;
    Object.assign(context.canvas, { width, height });
    context.drawImage(nearest.bitmap, 0, 0, width, height);
    return new Uint32Array(context.getImageData(0, 0, width, height).data.buffer);
  }
}
