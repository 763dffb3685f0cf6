// SPDX-License-Identifier: Apache-2.0
// The images of a pair of eyes, as they come, for whoever draws them.
import { sentHeader } from "../mtp";
import type { Arrival, GraphState, Server, Stream } from "../server";
import { moduleOf, portOf } from "../graph/structure";
import { bitmapOf } from "../views/picture";

export type Side = "left" | "right";

/** A module that sends the images of two eyes, or of one. */
export interface EyePair {
  readonly module: string;
  /** Names of its outputs. */
  readonly left: string;
  readonly right?: string;
  /** As the cameras take them: pixels can be pointed at. */
  readonly raw: boolean;
  /** With things in them that are not there. */
  readonly augmented: boolean;
}

/** The pairs of a graph: those of cameras first, augmented ones next. */
export function eyePairs(state: GraphState): EyePair[] {
  const outputs = new Set(state.links.map((link) => link.from));
  const inputs = new Set(state.links.map((link) => link.to));
  const pairs = state.modules.flatMap(({ name, program }): EyePair[] => {
    const [left, right] = [`${name}.left`, `${name}.right`];
    if (!outputs.has(left) && !outputs.has(right)) return [];
    return [
      {
        module: name,
        left: outputs.has(left) ? left : right,
        right: outputs.has(left) && outputs.has(right) ? right : undefined,
        raw: !inputs.has(left) && !inputs.has(right),
        augmented: program.split("/").at(-1) === "augment",
      },
    ];
  });
  const order = (pair: EyePair): number => (pair.raw ? 0 : pair.augmented ? 1 : 2);
  return pairs.sort((a, b) => order(a) - order(b));
}

/** The output that hears: sound that goes to a module `hearing`, or any that is called sound. */
export function earsOf(state: GraphState): string | undefined {
  const sounds = state.links.filter((link) => portOf(link.from) === "sound");
  const toHearing = sounds.find((link) => {
    const reader = state.modules.find((module) => module.name === moduleOf(link.to));
    return reader?.program.split("/").at(-1) === "hearing";
  });
  return toHearing?.from;
}

/** An image that has been decoded. */
export interface Picture {
  readonly bitmap: ImageBitmap;
  /** When it was taken [ns]. */
  readonly time: bigint;
  readonly coord: number;
  /** Of the sensor [px]; the bitmap may be smaller. */
  readonly width: number;
  readonly height: number;
  /** When it came, and was decoded [ms since the Unix epoch]. */
  readonly arrived: number;
  readonly decoded: number;
}

/** One eye's stream. */
export class Eye {
  private readonly stream: Stream;
  private closed = false;
  picture?: Picture;

  constructor(
    server: Server,
    port: string,
    width: number,
    private readonly shown: (picture: Picture) => void,
    problem: (text: string) => void,
  ) {
    this.stream = server.stream(port, { as: "jpeg", width });
    this.stream.on("message", (arrival) => this.take(arrival));
    this.stream.on("problem", problem);
  }

  setWidth(width: number): void {
    this.stream.setWidth(width);
  }

  close(): void {
    this.closed = true;
    this.stream.close();
    this.picture?.bitmap.close();
    this.picture = undefined;
  }

  private async take({ message, at }: Arrival): Promise<void> {
    const bitmap = await bitmapOf(message);
    if (!bitmap || this.closed) return bitmap?.close();
    const sensor = sentHeader(this.stream.header ?? "") ?? message.header;
    this.picture?.bitmap.close();
    this.picture = {
      bitmap,
      time: message.header.time,
      coord: message.header.coord,
      width: sensor.width,
      height: sensor.height,
      arrived: at,
      decoded: Date.now(),
    };
    this.shown(this.picture);
  }
}
