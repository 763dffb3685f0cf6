// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { found, wordFor, type Group } from "./choices";

const stream = (port: string, detail: string, type: string) => ({
  label: port,
  detail,
  type,
  args: { kind: "stream", port },
});
const groups: Group[] = [
  {
    name: "Panels",
    summary: "",
    choices: [{ label: "Graph", detail: "modules and links", args: { kind: "graph" } }],
  },
  {
    name: "depth",
    summary: "Measures distances.",
    choices: [stream("depth.depth", "along the axis", "intensity_image of 1 × f32")],
  },
  {
    name: "gaze",
    summary: "Turns the head.",
    choices: [
      stream("gaze.bid", "while there is a target", "table of 1 × f64"),
      stream("gaze.command", "orientation of the head", "rotation of 3 × f64"),
    ],
  },
];
const labels = (typed: string, type = "") =>
  found(groups, typed, type).flatMap(({ choices }) => choices.map(({ label }) => label));

test("a search finds names, descriptions and types, all its words", () => {
  assert.equal(labels("").length, 4);
  assert.deepEqual(labels("COMMAND"), ["gaze.command"]);
  assert.deepEqual(labels("head orientation"), ["gaze.command"]);
  assert.deepEqual(labels("distances"), ["depth.depth"]);
  assert.deepEqual(labels("nothing like it"), []);
});

test("groups that begin with the first word come first", () => {
  assert.deepEqual(labels("ga"), ["gaze.bid", "gaze.command"]);
  assert.deepEqual(found(groups, "g", "")[0]!.name, "gaze");
  assert.deepEqual(found(groups, "", "")[0]!.name, "Panels");
});

test("a type leaves only its streams", () => {
  assert.deepEqual(labels("", "Images"), ["depth.depth"]);
  assert.deepEqual(labels("", "Poses"), ["gaze.command"]);
  assert.deepEqual(labels("bid", "Poses"), []);
});

test("types have names that people use", () => {
  assert.equal(wordFor("rgb_image of 3 × u8"), "images");
  assert.equal(wordFor("vector_field of 6 × f32"), "3D");
  assert.equal(wordFor("sparse_graph of 3 × f64"), "sparse_graph of 3 × f64");
});
