// SPDX-License-Identifier: Apache-2.0
// Presets of streams to record, by their types, and their estimated rates. Pure.
import { Coord } from "../mtp";
import type { Outlet, Output } from "../outputs";
import type { GraphLink } from "../server";

export interface Preset {
  readonly name: string;
  readonly detail: string;
  readonly ports: readonly string[];
}

/** Bytes of an image as it is sent for one in a recording, as JPEG (measured on the head at 800 × 600). */
const jpegFactor = 13;

/** Images, clouds, maps and sound: large, unlike numbers and text. */
function isLarge({ kind }: Output): boolean {
  return kind !== undefined && /image|vector_field|map|sound|dense_graph/.test(kind.type);
}

/** Images in bytes and sound, as eyes and ears give them; no depth. */
function isSense({ kind }: Output): boolean {
  if (kind?.type === "sound") return true;
  return kind?.scalar === "u8" && /image/.test(kind.type) && kind.coord !== Coord.disparity;
}

function isMotion({ kind }: Output): boolean {
  return kind !== undefined && /position|rotation|transformation/.test(kind.type);
}

/** The presets for the modules of a graph, each with at least one stream. */
export function presetsOf(outlets: readonly Outlet[]): Preset[] {
  const all = outlets.flatMap(({ outputs }) => outputs);
  // Results computed from images and sound can be computed again.
  const senses = outlets.filter(({ perceives }) => !perceives).flatMap(({ outputs }) => outputs);
  const chosen = (outputs: readonly Output[], takes: (output: Output) => boolean) =>
    outputs.filter(takes).map(({ port }) => port);
  const small = chosen(all, (output) => !isLarge(output));
  return [
    {
      name: "Senses and actions",
      detail: "images of the eyes, sound, and all numbers and texts",
      ports: [...chosen(senses, isSense), ...small].sort(),
    },
    {
      name: "Poses and commands",
      detail: "positions, directions, and commands to move",
      ports: chosen(all, isMotion),
    },
    {
      name: "Everything",
      detail: "also what is computed from the images: depth, points, pictures",
      ports: chosen(all, () => true),
    },
  ].filter(({ ports }) => ports.length > 0);
}

/** The estimated size of a recording. */
export interface Amount {
  /** [byte/s], of those whose rate is known. */
  readonly rate: number;
  /** Outputs without a link, whose rate is unknown until they are read. */
  readonly unknown: number;
}

/** An estimate from what the links of the graph carry now. */
export function amountOf(
  ports: readonly string[],
  outputs: readonly Output[],
  links: readonly GraphLink[],
): Amount {
  const isPicture = new Map(
    outputs.map((output) => [output.port, isSense(output) && output.kind?.type !== "sound"]),
  );
  let [rate, unknown] = [0, 0];
  for (const port of ports) {
    const carried = links.filter(({ from }) => from === port);
    if (carried.length === 0) unknown += 1;
    const most = Math.max(0, ...carried.map(({ bytes_per_second: each }) => each));
    rate += isPicture.get(port) ? most / jpegFactor : most;
  }
  return { rate, unknown };
}
