// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { GraphModule } from "../server";
import { Failures } from "./failures";
import { linkOf, moduleNamed, stateOf } from "./graph_file";
import { layoutOf } from "./layout";
import { structureKey, structureOf } from "./structure";
import {
  bytesText,
  degreesText,
  durationText,
  limitTexts,
  moduleCondition,
  rateText,
} from "./words";

const head = stateOf(
  [
    moduleNamed("eyes", { group: "head" }),
    moduleNamed("ball"),
    moduleNamed("track"),
    moduleNamed("neck", { group: "head" }),
  ],
  [
    linkOf("eyes.left", "ball.left"),
    linkOf("eyes.right", "ball.right"),
    linkOf("ball.target", "track.target"),
    linkOf("track.command", "neck.command"),
    linkOf("neck.pose", "track.frames"),
    linkOf("file:x.mtp", "track.calibration"),
  ],
);

const closed = new Set<string>();

test("links between two modules are one edge, and those of poses are background", () => {
  const { edges } = structureOf(head, closed);
  assert.deepEqual(
    edges.map(({ key, links, background }) => [key, links.length, background]),
    [
      ["eyes>ball", 2, false],
      ["ball>track", 1, false],
      ["track>neck", 1, false],
      ["neck>track", 1, true],
      ["file:x.mtp>track", 1, false],
    ],
  );
});

test("the layout is the same for the same structure, from left to right, nothing overlaps", () => {
  const layout = layoutOf(structureOf(head, closed));
  assert.deepEqual(layout, layoutOf(structureOf({ ...head, uptime: 7 }, closed)));
  const boxes = ["eyes", "ball", "track", "neck"].map((name) => layout.nodes.get(name)!);
  boxes.slice(1).forEach((box, i) => {
    assert.ok(box.x - box.width / 2 > boxes[i]!.x + boxes[i]!.width / 2);
  });
});

const frames = "robot 10 world 0 0 1.2 0 0 0 1; head 11 robot neck.pose 3";

test("a node that moves a frame shows its pose, and has room for it", () => {
  const poses = (open: ReadonlySet<string>) =>
    structureOf(head, open, frames).nodes.flatMap(({ key, pose }) => (pose ? [[key, pose]] : []));
  assert.deepEqual(poses(closed), [["neck", "neck.pose"]]);
  const box = layoutOf(structureOf(head, closed, frames)).nodes.get("neck")!;
  const usual = layoutOf(structureOf(head, closed)).nodes.get("neck")!;
  assert.ok(box.height >= usual.height + 16 && box.width > usual.width);
  assert.notEqual(structureKey(head, closed, frames), structureKey(head, closed));
});

test("an output that moves several frames shows no pose", () => {
  const two = `${frames}; hand 12 robot neck.pose 3`;
  assert.ok(structureOf(head, closed, two).nodes.every(({ pose }) => pose === ""));
});

test("angles are whole degrees with their sign", () => {
  assert.deepEqual([12.4, -3.3, -0.4, 179.6].map(degreesText), ["12°", "−3°", "0°", "180°"]);
});

test("numbers are short", () => {
  assert.deepEqual([0, 0.13, 9.96, 20.12, 1999.4].map(rateText), [
    "",
    "0.13/s",
    "10/s",
    "20/s",
    "2 k/s",
  ]);
  assert.deepEqual([53e-6, 0.0294, 1.2, 61].map(durationText), [
    "53 µs",
    "29 ms",
    "1.2 s",
    "1 min 1 s",
  ]);
  assert.deepEqual([12, 105769984].map(bytesText), ["12 B", "106 MB"]);
});

test("a broken module says why", () => {
  assert.deepEqual(moduleCondition(moduleNamed("a")), { is: "works", why: "" });
  assert.deepEqual(moduleCondition(moduleNamed("a", { status: "waiting", exit: 137 })), {
    is: "broken",
    why: "was killed by signal 9; will be restarted",
  });
  const stalled = moduleNamed("a", { status: "stalled", detail: "stopped by a signal" });
  assert.deepEqual(moduleCondition(stalled), { is: "broken", why: "stopped by a signal" });
  const busy = moduleNamed("a", { status: "stalled", detail: "busy" });
  assert.deepEqual(moduleCondition(busy), { is: "slow", why: "busy" });
  const blocked = moduleNamed("a", { detail: "blocked: output left waits for its reader" });
  assert.equal(moduleCondition(blocked).is, "slow");
});

test("a failure is shown for a while after the module was restarted", () => {
  const failures = new Failures();
  const at = (uptime: number, other: Partial<GraphModule>): string => {
    const module = moduleNamed("a", other);
    failures.take(stateOf([module], [], uptime));
    const { is, why } = failures.conditionOf(module);
    return `${is} ${why}`;
  };
  assert.equal(at(1, {}), "works ");
  const killed = { restarts: 1, exit: 137 };
  assert.equal(at(2, killed), "broken was killed by signal 9; was restarted");
  assert.equal(at(4, killed), "broken was killed by signal 9; was restarted");
  assert.equal(at(6, killed), "works ");
  assert.equal(at(7, { restarts: 2, exit: 0 }), "works ");
});

test("drops are reported with their reasons", () => {
  const link = linkOf("a.out", "b.in", { dropped_newer: 2, ignored: 1200 });
  assert.deepEqual(limitTexts(link), [
    "2 dropped for a newer message",
    "1,200 ignored, because another task had the focus",
  ]);
  const limited = { ...link, bandwidth: 5e5, images: [62, 0.75] as const, dropped_newer: 0 };
  assert.equal(limitTexts(limited)[0], "at most 500 kB/s: quality 62, scale 0.75");
});
