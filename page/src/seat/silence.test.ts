// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { linkOf, moduleNamed, stateOf } from "../graph/graph_file";
import type { GraphModule } from "../server";
import { silenceText } from "./silence";

const port = "rectify.left";

/** A camera, a rectifier of its images, and a neck, which sends it frames and obeys it. */
const graph = (camera: Partial<GraphModule> = {}, rectify: Partial<GraphModule> = {}) =>
  stateOf(
    [moduleNamed("camera", camera), moduleNamed("rectify", rectify), moduleNamed("neck")],
    [
      linkOf("camera.left", "rectify.left"),
      linkOf("neck.pose", "rectify.frames"),
      linkOf("rectify.left", "neck.image"),
    ],
  );

test("while images come, and before the first, nothing is wrong", () => {
  const starts = graph({ status: "starting" });
  assert.equal(silenceText(true, 1900, starts, port), "");
  assert.equal(silenceText(false, 1900, starts, port), "Waiting for the first image…");
  assert.equal(silenceText(false, 60_000, graph(), port), "Waiting for the first image…");
});

test("an old image is said to be old, and why", () => {
  assert.equal(silenceText(true, 3400, graph(), port), "The last image is 3 s old.");
  assert.equal(silenceText(true, 14_000, graph(), port), "The last image is 10 s old.");
  assert.equal(
    silenceText(true, 3000, graph({ status: "given up", detail: "no device /dev/video0" }), port),
    "The last image is 3 s old. Module camera: given up (no device /dev/video0).",
  );
  const camera = { status: "given up" } as const;
  assert.equal(
    silenceText(true, 3000, graph(camera, { status: "ended" }), port),
    "The last image is 3 s old. Module camera: given up.",
  );
  const warns = { last_level: "warning", last_line: "no device /dev/video0; retrying" } as const;
  assert.equal(
    silenceText(false, 3000, graph(warns, { last_line: "started" }), port),
    "Waiting for the first image… Module camera: no device /dev/video0; retrying.",
  );
  assert.equal(
    silenceText(false, 3000, graph({ ...warns, status: "given up", detail: "failed" }), port),
    "Waiting for the first image… Module camera: given up (failed): no device /dev/video0; retrying.",
  );
  assert.equal(
    silenceText(true, 3000, graph({ status: "ended" }), port),
    "The last image is 3 s old. Module camera: ended.",
  );
  assert.equal(
    silenceText(false, 3000, graph({}, { status: "stalled" }), port),
    "Waiting for the first image… Module rectify: stalled.",
  );
});
