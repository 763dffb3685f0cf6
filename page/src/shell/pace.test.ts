// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { Pace } from "./pace";

test("the first action runs at once, and the last one of a period at its end", async () => {
  const pace = new Pace(50);
  const ran: number[] = [];
  pace.run(() => ran.push(1));
  assert.deepEqual(ran, [1]);
  pace.run(() => ran.push(2));
  await new Promise<void>((resolve) =>
    pace.run(() => {
      ran.push(3);
      resolve();
    }),
  );
  assert.deepEqual(ran, [1, 3]);
});
