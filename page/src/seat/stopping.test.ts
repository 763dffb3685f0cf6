// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { Stopping } from "./stopping";

test("a stop that is pressed alarms until it is confirmed", () => {
  const stopping = new Stopping();
  stopping.connected(true);
  stopping.press(true, 1000);
  assert.equal(stopping.alarm(1249), "");
  assert.match(stopping.alarm(1250), /no answer yet/i);
  stopping.answered(true, "stop NOT confirmed: the workspace does not answer");
  assert.match(stopping.alarm(1100), /workspace/);
  stopping.heard(false);
  stopping.heard(null);
  assert.notEqual(stopping.alarm(9e9), "");
  assert.ok(stopping.isUnconfirmed);
  stopping.heard(true);
  assert.equal(stopping.alarm(9e9), "");
  assert.ok(!stopping.isUnconfirmed);
});

test("a stop without a connection alarms at once, pressed before it was lost or after", () => {
  const stopping = new Stopping();
  stopping.press(true, 0);
  assert.match(stopping.alarm(0), /no connection/);
  stopping.connected(true);
  assert.equal(stopping.alarm(100), "");
  stopping.connected(false);
  assert.match(stopping.alarm(100), /no connection/);
  stopping.connected(true);
  stopping.answered(true, "");
  stopping.connected(false);
  assert.equal(stopping.alarm(9e9), "");
});

test("a clear that fails alarms nobody, and does not end a stop that is pressed", () => {
  const stopping = new Stopping();
  stopping.connected(true);
  stopping.press(false, 0);
  stopping.answered(false, "NOT cleared");
  stopping.forgetClear();
  assert.equal(stopping.alarm(9e9), "");
  stopping.press(true, 0);
  stopping.answered(false, "");
  stopping.forgetClear();
  assert.ok(stopping.isUnconfirmed);
});
