// SPDX-License-Identifier: Apache-2.0
// What the seat says while no images come. Pure.
import type { GraphModule } from "../server";

export const waiting = "Waiting for the first image…";
/** Images that come after a longer time are rare enough to say how old the last one is [ms]. */
const patience = 2000;

/**
 * The sentence; "" while images come.
 *
 * @param since  the last image, or the request for the first [ms].
 * @param module  that sends them.
 */
export function silenceText(
  hasImage: boolean,
  since: number,
  module: GraphModule | undefined,
): string {
  if (since < patience) return hasImage ? "" : waiting;
  const text = hasImage ? `The last image is ${Math.floor(since / 1000)} s old.` : waiting;
  if (!module || module.status === "running") return text;
  const { name, status, detail } = module;
  return `${text} The module ${name} is ${status}${detail ? `: ${detail}` : ""}.`;
}
