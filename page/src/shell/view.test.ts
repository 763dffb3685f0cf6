// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { GraphState } from "../server";
import { layoutFor, viewOf, type View } from "./view";

const module = (name: string, program = name) => ({ name, program: `/bin/${program}` });
const link = (from: string, to: string) => ({ from, to });
const head = {
  modules: [
    module("rectify"),
    module("eyes", "simulator"),
    module("unit"),
    module("far", "depth"),
    module("augment"),
  ],
  links: [
    link("unit.motion", "eyes.motion"),
    link("eyes.left", "rectify.left"),
    link("eyes.right", "rectify.right"),
    link("rectify.left", "far.left"),
    link("rectify.right", "far.right"),
  ],
  focus: { workspace: 4 },
  modes: {},
} as unknown as GraphState;
const eyes = { ...head, modules: head.modules.slice(0, 3), focus: {} };
const plain = {
  modules: [module("a")],
  links: [link("a.x", "b.y")],
  focus: {},
  modes: {},
} as unknown as GraphState;

/** Kinds or ports of the panels, column by column. */
function shown(view: View, width: number, state = head): string[][] {
  return layoutFor(view, state, width).map(({ places }) =>
    places.map(({ args }) => args.port ?? args.kind),
  );
}

test("a URL names a view, or panels, which are shown in Build", () => {
  assert.deepEqual(["#drive", "#watch", "#build"].map(viewOf), ["drive", "watch", "build"]);
  assert.deepEqual(["", "#"].map(viewOf), ["watch", "watch"]);
  assert.deepEqual(["#seat", "#stream,port=a.b|graph**2"].map(viewOf), ["build", "build"]);
});

test("Drive is the seat", () => {
  assert.deepEqual(shown("drive", 100), [["seat"]]);
});

test("Watch shows the bids and what the robot sees beside the graph", () => {
  assert.deepEqual(shown("watch", 85), [["graph"], ["bids", "augment.left", "far.depth", "log"]]);
  assert.deepEqual(shown("watch", 24), [["graph", "bids", "augment.left", "far.depth", "log"]]);
});

test("the bids grow with the tasks, so that each has a row", () => {
  const bids = (tasks: number) => {
    const modes = Object.fromEntries(
      [...Array(tasks).keys()].map((mode) => [`task_${mode}`, mode]),
    );
    return layoutFor("watch", { ...head, modes }, 85)[1]!.places[0];
  };
  assert.deepEqual(bids(5), { args: { kind: "bids" }, share: 1 });
  assert.deepEqual(bids(8), { args: { kind: "bids" }, share: 1.6 });
});

test("without depth and virtual objects it sees with the eyes that no other pair feeds", () => {
  assert.deepEqual(shown("watch", 85, eyes), [["graph"], ["eyes.left", "eyes.right", "log"]]);
});

test("Build has as many columns as there is room for", () => {
  const two = [
    ["graph", "log"],
    ["augment.left", "far.depth"],
  ];
  assert.deepEqual(shown("build", 85), two);
  assert.deepEqual(shown("build", 100), [...two, ["recordings"]]);
  assert.deepEqual(shown("build", 85, plain), [["graph", "log"]]);
});
