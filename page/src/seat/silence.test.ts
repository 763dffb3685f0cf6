// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { GraphModule } from "../server";
import { silenceText } from "./silence";

const camera = (status: string, detail = ""): GraphModule =>
  ({ name: "camera", status, detail }) as GraphModule;

test("while images come, and before the first, nothing is wrong", () => {
  assert.equal(silenceText(true, 1900, camera("starting")), "");
  assert.equal(silenceText(false, 1900, camera("starting")), "Waiting for the first image…");
  assert.equal(silenceText(false, 60_000, camera("running")), "Waiting for the first image…");
});

test("an old image is said to be old, and why", () => {
  assert.equal(silenceText(true, 12_400, undefined), "The last image is 12 s old.");
  assert.equal(
    silenceText(true, 3000, camera("given up", "no device /dev/video0")),
    "The last image is 3 s old. The module camera is given up: no device /dev/video0.",
  );
  assert.equal(
    silenceText(false, 3000, camera("stalled")),
    "Waiting for the first image… The module camera is stalled.",
  );
});
