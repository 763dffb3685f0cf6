// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { black, code, codings, SlowRange, type Coding, type Grid } from "./coding";

const gridOf = (values: number[], width = values.length): Grid => ({
  values,
  width,
  isZeroUnknown: true,
});

function coded(values: number[], coding: Coding, image?: number[]): number[] {
  const pixels = new Uint32Array(values.length);
  code(gridOf(values), [1, 3], coding, black, pixels, image && Uint32Array.from(image));
  return [...pixels];
}

test("unknown values are counted, and as holes in each coding", () => {
  for (const coding of codings) {
    const pixels = new Uint32Array(5);
    const grid = gridOf([0, NaN, Infinity, 1, 2]);
    assert.equal(code(grid, [1, 3], coding, black, pixels, new Uint32Array(5).fill(~0)), 3);
    assert.deepEqual([...pixels].slice(0, 3), [0xff000000, 0xff000000, 0xff000000]);
    assert.ok([...pixels].slice(3).every((pixel) => pixel > 0xff000000));
  }
});

test("fog fades an image by distance, as in hc view", () => {
  const image = [0.5, 1, 2, 9].map(() => 0xff19_7d_e1); // 225, 125, 25
  const [near, least, middle, far] = coded([0.5, 1, 2, 9], "fog", image);
  assert.equal(near, 0xff19_7d_e1);
  assert.equal(least, near);
  assert.equal(middle, 0xff73_aa_e1); // 225, 170, 115
  assert.equal(far, 0xffcd_d7_e1);
});

test("a relief is darker than the colours where it comes nearer, and not beside holes", () => {
  const values = [2, 2, 1.99, 0, 1.98];
  const [flat, relief] = [coded(values, "colours"), coded(values, "relief")];
  const green = (pixel?: number) => (pixel! >> 8) & 255;
  assert.equal(relief[1], flat[1]);
  assert.ok(green(relief[2]) < green(flat[2]));
  assert.equal(relief[4], flat[4]);
});

test("both eyes of a time have one range, which follows slowly", () => {
  const range = new SlowRange();
  assert.equal(range.update(gridOf([0, 0]), 1n), undefined);
  assert.deepEqual(range.update(gridOf([1, 2]), 1n), [1, 1]);
  assert.deepEqual(range.update(gridOf([9, 9]), 1n), [1, 1]);
  assert.deepEqual(range.update(gridOf([6, 6]), 2n), [2, 2]);
});

test("a fixed range stays, once there is one", () => {
  const range = new SlowRange();
  range.isFixed = true;
  assert.deepEqual(range.update(gridOf([1, 2])), [1, 1]);
  assert.deepEqual(range.update(gridOf([6, 6])), [1, 1]);
  range.isFixed = false;
  assert.deepEqual(range.update(gridOf([6, 6])), [2, 2]);
});
