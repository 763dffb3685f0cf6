// SPDX-License-Identifier: Apache-2.0
// What the seat says while no images come. Pure.
import { moduleOf, type GraphModule, type GraphState } from "../server";

export const waiting = "Waiting for the first image…";
/** Images that come after a longer time are rare enough to say how old the last one is [ms]. */
const patience = 2000;
/** Steps of the age, so that a screen reader does not repeat it each second [s]. */
const step = 5;

/**
 * The sentence; "" while images come.
 *
 * @param since  the last image, or the request for the first [ms].
 * @param port  that sends them.
 */
export function silenceText(
  hasImage: boolean,
  since: number,
  state: GraphState,
  port: string,
): string {
  if (since < patience) return hasImage ? "" : waiting;
  const seconds = since / 1000;
  const age = seconds < step ? Math.floor(seconds) : Math.floor(seconds / step) * step;
  const text = hasImage ? `The last image is ${age} s old.` : waiting;
  const reason = reasonOf(state, moduleOf(port));
  return reason ? `${text} ${reason}` : text;
}

/** Which module does not run: the one that sends the images, or one before it. */
function reasonOf(state: GraphState, sender: string): string {
  const names = new Set([sender]);
  for (const name of names) {
    const module = state.modules.find((each) => each.name === name);
    if (module && module.status !== "running") return conditionOf(module);
    for (const { from, to } of state.links) if (moduleOf(to) === name) names.add(moduleOf(from));
  }
  return "";
}

function conditionOf({ name, status, detail }: GraphModule): string {
  return `Module ${name}: ${status}${detail ? ` (${detail})` : ""}.`;
}
