// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { textMessage } from "../mtp";
import { Past } from "./past";

const message = textMessage("");

test("where memory is short the past becomes coarser, not shorter", () => {
  const past = new Past(1000);
  for (let i = 0; i < 1000; ++i) past.push({ message, at: i * 100, bytes: 10 });
  assert.ok(past.length <= 100);
  assert.ok(past.at(0)!.at < 30_000);
  assert.equal(past.at(past.length - 1)!.at, 99_900);
  assert.equal(past.at(past.length - 2)!.at, 99_800);
});

test("what is older than ten minutes goes", () => {
  const past = new Past();
  for (let minute = 0; minute < 30; ++minute) past.push({ message, at: minute * 60_000, bytes: 1 });
  assert.equal(past.length, 11);
});

test("a message larger than the memory is kept alone", () => {
  const past = new Past(10);
  past.push({ message, at: 0, bytes: 100 });
  past.push({ message, at: 1, bytes: 100 });
  assert.equal(past.length, 1);
});
