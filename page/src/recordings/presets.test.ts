// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Outlet } from "../outputs";
import type { GraphLink } from "../server";
import { amountOf, presetsOf } from "./presets";

function outlet(name: string, perceives: boolean, types: Record<string, string>): Outlet {
  const outputs = Object.entries(types).map(([output, words]) => {
    const [type = "", scalar = "f64", coord = "0"] = words.split(" ");
    const kind = { type, scalar, coord: Number(coord), components: 1, width: 0, height: 0 };
    return { port: `${name}.${output}`, type, kind, doc: "", columns: [] };
  });
  return { name, program: name, summary: "", perceives, outputs };
}

const outlets = [
  outlet("eyes", false, {
    left: "rgb_image u8",
    depth: "intensity_image f32 11",
    ears: "sound i16",
  }),
  outlet("match", true, { colours: "rgb_image u8", depth: "intensity_image f32 11" }),
  outlet("neck", false, { pose: "transformation", note: "string u8" }),
  outlet("follow", true, { command: "rotation", bid: "table" }),
];

function ports(name: string): readonly string[] | undefined {
  return presetsOf(outlets).find((preset) => preset.name === name)?.ports;
}

test("presets follow from the types of the outputs", () => {
  assert.deepEqual(ports("Everything")?.length, 9);
  assert.deepEqual(ports("Poses and commands"), ["neck.pose", "follow.command"]);
  assert.deepEqual(ports("Senses and actions"), [
    "eyes.ears",
    "eyes.left",
    "follow.bid",
    "follow.command",
    "neck.note",
    "neck.pose",
  ]);
});

test("a graph without poses has no preset for them", () => {
  const names = presetsOf([outlets[1]!]).map(({ name }) => name);
  assert.deepEqual(names, ["Everything"]);
});

test("the amount is that of the fastest link of each output, images in JPEG", () => {
  const link = (from: string, bytes_per_second: number) =>
    ({ from, to: "x.in", bytes_per_second }) as unknown as GraphLink;
  const links = [link("eyes.left", 1e6), link("eyes.left", 3.9e7), link("neck.pose", 500)];
  const outputs = outlets.flatMap((each) => each.outputs);
  assert.deepEqual(amountOf(["eyes.left", "neck.pose", "neck.note"], outputs, links), {
    rate: 3e6 + 500,
    unknown: 1,
  });
});
