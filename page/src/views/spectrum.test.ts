// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { channelsOf, level, spectrum } from "./spectrum";

test("a full sine is 0 dB at its frequency, and far less elsewhere", () => {
  const samples = Float64Array.from({ length: 512 }, (_, i) =>
    Math.sin((2 * Math.PI * 40 * i) / 512),
  );
  const sizes = spectrum(samples);
  assert.equal(sizes.length, 256);
  assert.ok(Math.abs(sizes[40]!) < 0.01);
  assert.ok(sizes[30]! < -80 && sizes[200]! < -80);
});

test("levels", () => {
  assert.equal(level([1, -1, 1, -1]), 0);
  assert.ok(Math.abs(level([0.1, -0.1]) + 20) < 1e-9);
  assert.equal(level([0, 0]), -100);
  assert.equal(level([]), -100);
});

test("channels and the ranges of scalars", () => {
  assert.deepEqual(channelsOf([-32768, 0, 16384, 32767], "i16", 2), [
    Float32Array.of(-1, 0.5),
    Float32Array.of(0, 32767 / 32768),
  ]);
  assert.deepEqual(channelsOf([0, 128, 192], "u8", 1), [Float32Array.of(-1, 0, 0.5)]);
  assert.deepEqual(channelsOf([-3, 0.25], "f32", 1), [Float32Array.of(-1, 0.25)]);
});
