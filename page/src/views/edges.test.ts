// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { headerOf } from "../mtp";
import { networkOf } from "./edges";

test("a dense graph's edges are its elements that are not 0", () => {
  const kind = { type: "dense_graph", components: 1, scalar: "f32", encoding: "binary" } as const;
  const message = { header: headerOf(kind, 2, 2), elements: Float32Array.of(0, 2, 0, -1) };
  assert.deepEqual(networkOf(message), {
    nodes: 2,
    edges: [
      { from: 0, to: 1, weights: [2] },
      { from: 1, to: 1, weights: [-1] },
    ],
  });
});

test("a sparse graph's edges are its rows; a row to itself with weight 0 is a node", () => {
  const kind = { type: "sparse_graph", components: 3, scalar: "i32", encoding: "binary" } as const;
  const message = { header: headerOf(kind, 1, 2), elements: Int32Array.of(0, 1, 5, 3, 3, 0) };
  assert.deepEqual(networkOf(message), { nodes: 4, edges: [{ from: 0, to: 1, weights: [5] }] });
});

test("an empty one", () => {
  const kind = { type: "sparse_graph", components: 2, scalar: "u8", encoding: "text" } as const;
  const message = { header: headerOf(kind, 1, 0), elements: new Uint8Array(0) };
  assert.deepEqual(networkOf(message), { nodes: 0, edges: [] });
});
