// SPDX-License-Identifier: Apache-2.0
// Which outputs of a graph tell of the people in an image. Pure.
import type { Output } from "../outputs";
import { moduleOf, portOf, type GraphState } from "../server";

/** Outputs, MODULE.PORT. */
export interface PeoplePorts {
  readonly faces?: string;
  readonly names?: string;
  readonly attended?: string;
  readonly hands?: string;
}

/** The module from which the images of a module come. */
function originOf(links: GraphState["links"], module: string): string {
  const passed = new Set<string>();
  while (!passed.has(module)) {
    passed.add(module);
    const inputs = [`${module}.left`, `${module}.image`];
    const link = links.find(({ to }) => inputs.includes(to));
    if (!link) break;
    module = moduleOf(link.from);
  }
  return module;
}

/**
 * The outputs that tell of the people in an image.
 *
 * @param outputs  of the graph, as its modules describe them.
 * @param links  of the graph; undefined: unknown, as in a recording.
 * @param image  the output with the image.
 */
export function peoplePorts(
  outputs: readonly Output[],
  links: GraphState["links"] | undefined,
  image: string,
): PeoplePorts {
  const tables = (name: string): string[] =>
    outputs
      .filter(({ port, kind, columns }) => {
        return portOf(port) === name && kind?.type === "table" && columns.includes("track");
      })
      .map(({ port }) => port);
  const isOfImage = (port: string): boolean =>
    !links || originOf(links, moduleOf(port)) === originOf(links, moduleOf(image));
  const faces = tables("faces").find(isOfImage);
  const hands = tables("hands").find(isOfImage);
  if (!faces) return { hands };
  const readers = links?.filter(({ from }) => from === faces).map(({ to }) => to);
  const choosers = readers && [faces, ...readers].map(moduleOf);
  const names = outputs.find(({ port }) => port === `${moduleOf(faces)}.names`)?.port;
  const attended = tables("attended").find((port) => choosers?.includes(moduleOf(port)) ?? true);
  return { faces, names, attended, hands };
}
