// SPDX-License-Identifier: Apache-2.0
// The live images of a pair of eyes.
import { sentHeader } from "../mtp";
import type { Arrival, GraphState, Server, Stream } from "../server";
import { moduleOf, portOf } from "../graph/structure";
import { codings, type Coding, type SlowRange } from "../views/coding";
import { bitmapOf } from "../views/picture";
import { DepthEye } from "./depth_eye";

export type Side = "left" | "right";

/** A module that sends images of one or two eyes. */
export interface EyePair {
  readonly module: string;
  /** Names of its outputs. */
  readonly left: string;
  readonly right?: string;
  /** Unprocessed camera images, whose pixels can be selected as targets. */
  readonly raw: boolean;
  /** With virtual objects. */
  readonly augmented: boolean;
  /** Of a pair of depths: how they are shown, and what was matched. */
  readonly coding?: Coding;
  readonly images?: readonly (string | undefined)[];
}

/** Names of the modules of pairs, for a person. */
export function labelsOf(pairs: readonly EyePair[]): Map<string, string> {
  const labels = new Map(pairs.map((pair) => [pair.module, sortOf(pair)]));
  const all = [...labels.values()];
  for (const [module, label] of labels) {
    if (all.filter((each) => each === label).length > 1) labels.set(module, module);
  }
  return labels;
}

function sortOf({ module, raw, augmented, coding }: EyePair): string {
  return coding ? "Depth" : augmented ? "Virtual" : raw ? "Camera" : module;
}

/** The pairs of depths in a graph, in each coding: in fog if their images are known. */
function depthPairs(state: GraphState): EyePair[] {
  const programs = state.modules.filter(({ program }) => program.split("/").at(-1) === "depth");
  return programs.flatMap(({ name }) => {
    const images = ["left", "right"].map(
      (side) => state.links.find((link) => link.to === `${name}.${side}`)?.from,
    );
    const [left, right] = [`${name}.depth`, `${name}.right_depth`];
    const possible = codings.filter((coding) => coding !== "fog" || images.every(Boolean));
    return possible.map((coding) => {
      return { module: name, left, right, raw: false, augmented: false, coding, images };
    });
  });
}

/** The pairs in a graph: cameras first, then augmented ones, depths last. */
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
  return [...pairs.sort((a, b) => order(a) - order(b)), ...depthPairs(state)];
}

/** The output of the ears: linked to a module `hearing`, or any named sound. */
export function earsOf(state: GraphState): string | undefined {
  const sounds = state.links.filter((link) => portOf(link.from) === "sound");
  const toHearing = sounds.find((link) => {
    const reader = state.modules.find((module) => module.name === moduleOf(link.to));
    return reader?.program.split("/").at(-1) === "hearing";
  });
  return toHearing?.from;
}

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
  picture?: Picture;

  /** @param depth  undefined: the stream is of images. */
  constructor(
    server: Server,
    port: string,
    width: number,
    depth: DepthOptions | undefined,
    private readonly shown: (picture: Picture) => void,
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
    this.picture?.bitmap.close();
    this.picture = undefined;
  }

  private async take({ message, at }: Arrival): Promise<void> {
    const bitmap = await (this.depth ? this.depth.bitmapOf(message) : bitmapOf(message));
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
