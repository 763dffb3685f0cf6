// SPDX-License-Identifier: Apache-2.0
// The live images of an eye.
import { sentHeader } from "../mtp";
import type { Arrival, Server, Stream } from "../server";
import type { Coding, SlowRange } from "../views/coding";
import { bitmapOf } from "../views/picture";
import { DepthEye } from "./depth_eye";

/** A decoded image. */
export interface Picture {
  readonly bitmap: ImageBitmap;
  /** Time of exposure [ns]. */
  readonly time: bigint;
  readonly coord: number;
  /** Of the sensor [px]; the bitmap may be smaller. */
  readonly width: number;
  readonly height: number;
  /** Times of arrival and decoding [ms since the Unix epoch]. */
  readonly arrived: number;
  readonly decoded: number;
}

/** How an eye's depth is shown. */
export interface DepthOptions {
  readonly coding: Coding;
  /** The output with the eye's image, for fog. */
  readonly image?: string;
  /** Shared by both eyes, so that a point has one colour. */
  readonly range: SlowRange;
}

/** One eye's stream. */
export class Eye {
  private readonly stream: Stream;
  private readonly depth?: DepthEye;
  private closed = false;

  /**
   * @param depth  undefined: the stream is of images.
   * @param taken  gets each image, and closes it.
   */
  constructor(
    server: Server,
    port: string,
    width: number,
    depth: DepthOptions | undefined,
    private readonly taken: (picture: Picture) => void,
    problem: (text: string) => void,
  ) {
    this.stream = server.stream(port, { as: depth ? "raw" : "jpeg", width });
    if (depth) this.depth = new DepthEye(server, width, depth, problem);
    this.stream.on("message", (arrival) => this.take(arrival));
    this.stream.on("problem", problem);
  }

  setWidth(width: number): void {
    this.stream.setWidth(width);
    this.depth?.setWidth(width);
  }

  close(): void {
    this.closed = true;
    this.stream.close();
    this.depth?.close();
  }

  private async take({ message, at }: Arrival): Promise<void> {
    const bitmap = await (this.depth ? this.depth.bitmapOf(message) : bitmapOf(message));
    if (!bitmap || this.closed) return bitmap?.close();
    const sensor = sentHeader(this.stream.header ?? "") ?? message.header;
    this.taken({
      bitmap,
      time: message.header.time,
      coord: message.header.coord,
      width: sensor.width,
      height: sensor.height,
      arrived: at,
      decoded: Date.now(),
    });
  }
}
