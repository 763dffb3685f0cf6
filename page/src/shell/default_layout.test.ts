// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { GraphState, Session } from "../server";
import { defaultLayout } from "./default_layout";

const module = (name: string) => ({ name });
const link = (from: string, to: string) => ({ from, to });
const head = {
  modules: [module("rectify"), module("eyes"), module("unit")],
  links: [
    link("unit.motion", "eyes.motion"),
    link("eyes.left", "rectify.left"),
    link("eyes.right", "rectify.right"),
    link("rectify.left", "depth.left"),
    link("rectify.right", "depth.right"),
  ],
} as unknown as GraphState;
const session = { drives: ["stick"] } as unknown as Session;

/** Kinds or ports of the panels, column by column. */
function shown(state: GraphState, width: number, of = session): string[][] {
  return defaultLayout(state, of, width).map(({ places }) =>
    places.map(({ args }) => args.port ?? args.kind),
  );
}

test("the eyes are those that no other pair feeds", () => {
  assert.deepEqual(shown(head, 1600), [["eyes.left", "eyes.right"], ["graph"], ["seat"]]);
});

test("as many columns as there is room for", () => {
  assert.deepEqual(shown(head, 1000), [
    ["eyes.left", "eyes.right"],
    ["seat", "graph"],
  ]);
  assert.deepEqual(shown(head, 400), [["eyes.left", "seat", "eyes.right", "graph"]]);
});

test("a graph without eyes and seat", () => {
  const plain = { modules: [module("a")], links: [link("a.x", "b.y")] } as unknown as GraphState;
  assert.deepEqual(shown(plain, 1600, { drives: [] } as unknown as Session), [["graph"]]);
});
