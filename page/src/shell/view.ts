// SPDX-License-Identifier: Apache-2.0
// The three views of the page, and the panels that each shows. Pure.
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

/** An output of the first module that runs a program. */
function outputOf(state: GraphState, program: string, port: string): string | undefined {
  const found = state.modules.find((module) => module.program.split("/").at(-1) === program);
  return found && `${found.name}.${port}`;
}

/** The outputs left and right of a module that no other such pair feeds: the eyes. */
function eyesOf(state: GraphState): string[] {
  const outputs = new Set(state.links.map((link) => link.from));
  const pairs = state.modules
    .map(({ name }) => name)
    .filter((name) => outputs.has(`${name}.left`) && outputs.has(`${name}.right`));
  const isFed = (name: string) =>
    state.links.some(
      ({ from, to }) => to.startsWith(`${name}.`) && pairs.includes(from.split(".")[0]!),
    );
  const name = pairs.find((each) => !isFed(each));
  return name === undefined ? [] : [`${name}.left`, `${name}.right`];
}

/** What the robot sees: with virtual objects and in depth, or else both eyes. */
function picturesOf(state: GraphState): PanelArgs[] {
  const [left, right] = eyesOf(state);
  const augmented = outputOf(state, "augment", "left");
  const depth = outputOf(state, "depth", "depth");
  const picture = (port: string | undefined, title: string): PanelArgs[] =>
    port === undefined ? [] : [{ kind: "stream", port, title }];
  return [
    ...picture(augmented ?? left, augmented ? "What it sees, with virtual objects" : "Left eye"),
    ...picture(depth ?? right, depth ? "How far it is" : "Right eye"),
  ];
}

/**
 * The panels of a view.
 *
 * @param width  of the page [em].
 */
export function layoutFor(view: View, state: GraphState, width: number): Layout {
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

function column(share: number, ...panels: readonly PanelArgs[]) {
  return { share, places: panels.map((args) => ({ args, share: args.kind === "log" ? 0.6 : 1 })) };
}
