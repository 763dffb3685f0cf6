// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { test } from "node:test";
import { stateOfFile } from "./graph_file";
import { areaOf, overlap, placeLabels } from "./labels";
import { areasOf, layoutOf } from "./layout";
import { partsOf } from "./parts";
import { structureOf } from "./structure";

/** Each file of graphs/, with its parts closed, with each of them open, and with all open. */
const drawings = readdirSync(process.env.HC_GRAPHS ?? "")
  .filter((name) => name.endsWith(".toml"))
  .flatMap((file) => {
    const state = stateOfFile(file);
    const neck = state.modules.find(({ program }) => program === "pan_tilt");
    const frames = neck ? `head 11 robot ${neck.name}.pose 3` : "";
    const parts = partsOf(state).flatMap(({ key, members }) => (members.length > 1 ? [key] : []));
    return [[], ...parts.map((part) => [part]), parts].map((open) => ({
      name: `${file} with ${open.join(" and ") || "nothing"} open`,
      structure: structureOf(state, new Set(open), frames),
    }));
  });

test("no label of a link covers another one, a box or a caption", () => {
  for (const { name, structure } of drawings) {
    const { nodes, edges } = layoutOf(structure);
    const labels = structure.edges.flatMap(({ key }) => {
      const { label } = edges.get(key)!;
      return label ? [{ what: `the label of ${key}`, area: areaOf(label) }] : [];
    });
    const boxes = structure.nodes.flatMap((node) =>
      areasOf(node, nodes.get(node.key)!).map((area) => ({ what: node.key, area })),
    );
    labels.forEach((a, i) => {
      for (const b of [...labels.slice(i + 1), ...boxes])
        assert.ok(!overlap(a.area, b.area), `in ${name}, ${a.what} covers ${b.what}`);
    });
  }
});

test("while all parts are closed, each link with data has a label, also one that goes back", () => {
  for (const { name, structure } of drawings) {
    if (structure.nodes.some(({ part }) => part !== "")) continue;
    const { edges } = layoutOf(structure);
    for (const { key, background } of structure.edges)
      assert.ok(background || edges.get(key)!.label, `in ${name}, ${key} has no label`);
  }
});

test("a line that can have its label elsewhere leaves its start to one that cannot", () => {
  const box = (left: number) => ({ left, top: -24, right: left + 120, bottom: 24 });
  const there = [
    { x: 0, y: 0 },
    { x: 84, y: 0 },
  ];
  const back = [
    { x: 84, y: 0 },
    { x: 0, y: 40 },
    { x: -120, y: 40 },
    { x: -204, y: 0 },
  ];
  const lines = new Map([
    ["back", back],
    ["there", there],
  ]);
  const labels = placeLabels(lines, [box(-120), box(84)]);
  assert.deepEqual(labels.get("there"), { x: 5, y: -3, anchor: "start" });
  assert.deepEqual(labels.get("back"), { x: -5, y: 37, anchor: "end" });
});
