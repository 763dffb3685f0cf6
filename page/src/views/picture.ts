// SPDX-License-Identifier: Apache-2.0
// Decodes image messages for a canvas.
import { Coord, numbersOf, type Header, type Message } from "../mtp";

/** A decoded image; close() releases its memory. */
export type Picture = ImageBitmap | VideoFrame;

/** The encoding to request for images: VP8 if the browser decodes it. */
export async function bestEncoding(): Promise<"vp8" | "jpeg"> {
  if (typeof VideoDecoder === "undefined") return "jpeg";
  try {
    const { supported } = await VideoDecoder.isConfigSupported(vp8);
    return supported ? "vp8" : "jpeg";
  } catch {
    return "jpeg";
  }
}

const vp8: VideoDecoderConfig = {
  codec: "vp8",
  optimizeForLatency: true,
  // The matrix of VP8 (RFC 6386, 9.2); browsers assume another.
  colorSpace: {
    primaries: "bt709",
    transfer: "iec61966-2-1",
    matrix: "smpte170m",
    fullRange: false,
  },
};

export function isImage(header: Header): boolean {
  return header.type === "rgb_image" || header.type === "intensity_image";
}

/** Whether a message is a VP8 frame of an image (W9). */
export function isVideo(message: Message, sent: Header): boolean {
  return isImage(sent) && message.header.type === "table";
}

/** Decodes the images of one stream. */
export class PictureDecoder {
  private decoder?: VideoDecoder;
  private waiting: { resolve(frame: VideoFrame | undefined): void }[] = [];
  private needsKey = true;
  private count = 0;
  private restarted = -Infinity; // [ms]

  /** @param restart  requests a key frame. */
  constructor(private readonly restart: () => void = () => {}) {}

  /** Decodes a message; undefined if that is impossible. */
  async decode(message: Message, sent: Header): Promise<Picture | undefined> {
    return isVideo(message, sent)
      ? this.decodeVideo(message.elements as Uint8Array<ArrayBuffer>)
      : bitmapOf(message);
  }

  close(): void {
    if (this.decoder?.state !== "closed") this.decoder?.close();
    this.settle();
  }

  private settle(): void {
    for (const { resolve } of this.waiting.splice(0)) resolve(undefined);
  }

  private decodeVideo(bytes: Uint8Array<ArrayBuffer>): Promise<VideoFrame | undefined> {
    const isKey = bytes.length > 0 && (bytes[0]! & 1) === 0; // RFC 6386, 9.1
    if (!this.decoder || this.decoder.state === "closed") {
      this.needsKey = true;
      this.decoder = new VideoDecoder({
        output: (frame) => {
          const next = this.waiting.shift();
          if (next) next.resolve(frame);
          else frame.close();
        },
        error: () => this.settle(),
      });
      this.decoder.configure(vp8);
    }
    if (bytes.length === 0) return Promise.resolve(undefined);
    if (this.needsKey && !isKey) {
      const now = performance.now();
      if (now > this.restarted + 1000) {
        this.restarted = now;
        this.restart();
      }
      return Promise.resolve(undefined);
    }
    this.needsKey = false;
    const chunk = new EncodedVideoChunk({
      type: isKey ? "key" : "delta",
      timestamp: this.count++,
      data: bytes,
    });
    return new Promise((resolve) => {
      this.waiting.push({ resolve });
      this.decoder?.decode(chunk);
    });
  }
}

/** The value of white in an image. */
function whiteOf(header: Header): number {
  return { u8: 255, u16: 65535, u32: 2 ** 32 - 1, u64: 2 ** 64 }[header.scalar as string] ?? 1;
}

/** Decodes an image, JPEG or uncompressed; undefined if empty. */
export async function bitmapOf(message: Message): Promise<ImageBitmap | undefined> {
  if (message.header.encoding === "jpeg") {
    const blob = new Blob([message.elements as Uint8Array<ArrayBuffer>], { type: "image/jpeg" });
    return createImageBitmap(blob);
  }
  const data = pixelsOf(message);
  return data && createImageBitmap(data);
}

/** An uncompressed image as pixels of a canvas. */
function pixelsOf(message: Message): ImageData | undefined {
  const { header } = message;
  const { width, height, components } = header;
  if (width === 0 || height === 0) return undefined;
  const numbers = numbersOf(message);
  const data = new Uint8ClampedArray(4 * width * height);
  const scale = 255 / whiteOf(header);
  for (
    let pixel = 0, from = 0, to = 0;
    pixel < width * height;
    ++pixel, from += components, to += 4
  ) {
    for (let i = 0; i < 3; ++i) data[to + i] = numbers[from + (components > 2 ? i : 0)]! * scale;
    data[to + 3] = components === 4 ? numbers[from + 3]! * scale : 255;
  }
  return new ImageData(data, width, height);
}

/** Whether an image has measurements instead of brightness: depth, disparity. */
export function isMeasured(header: Header): boolean {
  return (
    header.type === "intensity_image" &&
    header.scalar !== "u8" &&
    [Coord.depth, Coord.disparity, Coord.right_depth].some((each) => each === header.coord)
  );
}
