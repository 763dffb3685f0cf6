// SPDX-License-Identifier: Apache-2.0
// The text of the seat while no images come. Pure.
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

/**
 * The module that does not run or complains: the one that sends the images, or one before it. One
 * that ended may have done its work, so others come first.
 */
function reasonOf(state: GraphState, sender: string): string {
  const names = new Set([sender]);
  for (const name of names)
    for (const { from, to } of state.links) if (moduleOf(to) === name) names.add(moduleOf(from));
  const modules = [...names].flatMap((name) => state.modules.filter((each) => each.name === name));
  const found =
    modules.find(({ status }) => status !== "running" && status !== "ended") ??
    modules.find((each) => each.status === "running" && complaintOf(each)) ??
    modules.find(({ status }) => status === "ended");
  return found ? conditionOf(found) : "";
}

/** The last line of its log, if it warns. */
function complaintOf({ last_level: level, last_line: line }: GraphModule): string {
  return level === "warning" || level === "error" ? line : "";
}

function conditionOf(module: GraphModule): string {
  const { name, status, detail } = module;
  const complaint = complaintOf(module);
  if (status === "running") return `Module ${name}: ${complaint}.`;
  return `Module ${name}: ${status}${detail ? ` (${detail})` : ""}${complaint && `: ${complaint}`}.`;
}
