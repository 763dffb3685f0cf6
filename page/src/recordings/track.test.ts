// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { numbersMessage, textMessage, writeMessage } from "../mtp";
import { openMessages } from "./track";

const second = 1_000_000_000n;

function file(times: readonly number[]): Blob {
  return new Blob(
    times.map((time, i) =>
      writeMessage(numbersMessage("table", [i], { time: BigInt(time) * second })),
    ),
  );
}

test("messages are found by their time", async () => {
  const track = await openMessages("a.b", file([100, 101, 103]));
  assert.equal(track.length, 3);
  assert.deepEqual(
    [99, 100, 102, 103, 500].map((time) => track.indexAt(time)),
    [-1, 0, 1, 2, 2],
  );
  assert.deepEqual([...(await track.message(1)).elements], [1]);
  assert.deepEqual([...(await track.message(2)).elements], [2]);
});

test("times that are missing or go back count as those before", async () => {
  const track = await openMessages("a.b", file([100, 0, 90, 101]));
  assert.deepEqual(
    [0, 1, 2, 3].map((index) => track.timeAt(index)),
    [100, 100, 100, 101],
  );
});

test("a recording that was broken off gives what is whole", async () => {
  const whole = file([1, 2]);
  const track = await openMessages("a.b", whole.slice(0, whole.size - 3));
  assert.equal(track.length, 1);
});

test("what is no message is refused", async () => {
  const bytes = writeMessage(textMessage("x"));
  await assert.rejects(openMessages("a.b", new Blob([bytes, "hello\n"])), /R5/);
});
