// SPDX-License-Identifier: Apache-2.0
// The eyes and ears of a graph. Pure.
import { moduleOf, portOf, programName, type GraphState } from "./server";
import { codings, type Coding } from "./views/coding";

/** A module that sends images of one or two eyes. */
export interface EyePair {
  readonly module: string;
  /** Names of its outputs. */
  readonly left: string;
  readonly right?: string;
  /** Unprocessed camera images, whose pixels can be selected as targets. */
  readonly raw: boolean;
  readonly rectified?: boolean;
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

function sortOf({ module, raw, rectified, augmented, coding }: EyePair): string {
  if (coding) return "Depth";
  if (augmented) return "Virtual";
  return raw ? "Camera" : rectified ? "Rectified" : module;
}

/** The pairs of depths in a graph, in each coding: in fog if their images are known. */
function depthPairs(state: GraphState): EyePair[] {
  const programs = state.modules.filter(({ program }) => programName(program) === "depth");
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
    const ports = [`${name}.left`, `${name}.right`];
    const augmented = programName(program) === "augment";
    const [left, right] = ports.filter((port) => augmented || outputs.has(port));
    if (left === undefined) return [];
    const raw = !ports.some((port) => inputs.has(port));
    const rectified = programName(program) === "rectify";
    return [{ module: name, left, right, raw, rectified, augmented }];
  });
  const order = (pair: EyePair): number => (pair.raw ? 0 : pair.augmented ? 1 : 2);
  return [...pairs.sort((a, b) => order(a) - order(b)), ...depthPairs(state)];
}

/** The output of the ears: linked to a module `hearing`, or any named sound. */
export function earsOf(state: GraphState): string | undefined {
  const sounds = state.links.filter((link) => portOf(link.from) === "sound");
  const toHearing = sounds.find((link) => {
    const reader = state.modules.find((module) => module.name === moduleOf(link.to));
    return reader && programName(reader.program) === "hearing";
  });
  return toHearing?.from;
}
