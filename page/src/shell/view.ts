// SPDX-License-Identifier: Apache-2.0
// The three views of the page, and the panels that each shows. Pure.
import { eyePairs } from "../eyes";
import type { GraphState } from "../server";
import type { Layout } from "./layout";
import type { PanelArgs } from "./panel";

export const views = ["drive", "watch", "build"] as const;
export type View = (typeof views)[number];

/** The view that the fragment of a URL names; panels are shown in Build. */
export function viewOf(hash: string): View {
  const name = hash.replace(/^#/, "") || "watch";
  return views.find((view) => view === name) ?? "build";
}

/** What the robot sees: with virtual objects and in depth, or else both eyes. */
function picturesOf(state: GraphState): PanelArgs[] {
  const pairs = eyePairs(state);
  const eyes = pairs.find(({ raw }) => raw) ?? pairs.find(({ coding }) => !coding);
  const augmented = pairs.find((pair) => pair.augmented);
  const depth = pairs.find(({ coding }) => coding);
  const picture = (port: string | undefined, title: string): PanelArgs[] =>
    port === undefined ? [] : [{ kind: "stream", port, title }];
  return [
    ...(augmented
      ? picture(augmented.left, "Left eye, with virtual objects")
      : picture(eyes?.left, "Left eye")),
    ...(depth ? picture(depth.left, "Depth") : picture(eyes?.right, "Right eye")),
  ];
}

/**
 * The panels of a view.
 *
 * @param width  of the page [em].
 */
export function layoutFor(view: View, state: GraphState, width: number): Layout {
  const tasks = Object.keys(state.modes).length;
  const column = (share: number, ...panels: readonly PanelArgs[]) => ({
    share,
    places: panels.map((args) => ({ args, share: shareOf(args.kind, tasks) })),
  });
  if (view === "drive") return [column(1, { kind: "seat" })];
  const seen = picturesOf(state);
  const pictures = view === "watch" ? seen : seen.map(({ title, ...args }) => args);
  const graph = { kind: "graph" };
  const log = { kind: "log" };
  const bids = Object.keys(state.focus).length > 0 ? [{ kind: "bids" }] : [];
  if (width < 46) return [column(1, graph, ...bids, ...pictures, log)];
  if (view === "watch") return [column(2.6, graph), column(1, ...bids, ...pictures, log)];
  const columns = [column(1.4, graph, log), column(1, ...pictures)];
  if (width >= 100) columns.push(column(1, { kind: "recordings" }));
  return columns.filter(({ places }) => places.length > 0);
}

/** How much of its column a panel gets: the bids so much that each task has its row. */
function shareOf(kind: string, tasks: number): number {
  return kind === "log" ? 0.6 : kind === "bids" ? Math.max(1, tasks / 5) : 1;
}
