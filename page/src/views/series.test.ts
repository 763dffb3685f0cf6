// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { Series } from "./series";

test("a window holds the times in it, and one more at each side", () => {
  const series = new Series(2);
  for (let i = 0; i < 10; ++i) series.push(100 + i, [i, -i]);
  assert.deepEqual(
    series.window(103, 105, [1]).map((column) => [...column]),
    [
      [102, 103, 104, 105],
      [-2, -3, -4, -5],
    ],
  );
});

test("memory is bounded, and the newest stay", () => {
  const series = new Series(1, 4000);
  for (let i = 0; i < 20_000; ++i) series.push(i / 100, [i]);
  assert.ok(series.length <= 4096);
  assert.equal(series.lastTime, 199.99);
  assert.deepEqual(
    series.window(199.99, 300, [0]).map((column) => [...column]),
    [
      [199.98, 199.99],
      [19_998, 19_999],
    ],
  );
});

test("what is older than ten minutes goes", () => {
  const series = new Series(1);
  for (let i = 0; i < 5000; ++i) series.push(i, [i]);
  assert.ok(series.lastTime - series.firstTime < 1100);
});

test("a source that starts over begins a new series", () => {
  const series = new Series(1);
  series.push(1000, [1]);
  series.push(10, [2]);
  assert.equal(series.length, 1);
  assert.equal(series.lastTime, 10);
});
