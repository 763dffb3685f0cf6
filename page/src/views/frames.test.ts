// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { framesOf } from "./frames";

test("frames come with parents before children", () => {
  const text =
    "left_eye 4 head 0.06 0.05 0.05 -0.5 0.5 -0.5 0.5; head 3 robot head_neck.pose 57; " +
    "robot 2 world 0 0 1.2 0 0 0 1";
  assert.deepEqual(framesOf(text), [
    {
      name: "robot",
      coord: 2,
      parent: "world",
      fixed: { translation: [0, 0, 1.2], quaternion: [0, 0, 0, 1] },
    },
    { name: "head", coord: 3, parent: "robot", movedBy: "head_neck.pose" },
    {
      name: "left_eye",
      coord: 4,
      parent: "head",
      fixed: { translation: [0.06, 0.05, 0.05], quaternion: [-0.5, 0.5, -0.5, 0.5] },
    },
  ]);
});

test("no frames, no list", () => assert.deepEqual(framesOf(""), []));
