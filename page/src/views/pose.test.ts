// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { Coord, headerOf, type Message } from "../mtp";
import { angleText, placeText, poseOf } from "./pose";

function transformation(rows: readonly (readonly number[])[], to: number, from: number): Message {
  const kind = { type: "transformation", components: 1, scalar: "f64", encoding: "text" } as const;
  const header = headerOf(kind, 4, 4, { coord: 1000 * to + from });
  return { header, elements: Float64Array.from([...rows.flat(), 0, 0, 0, 1]) };
}

function rounded(message: Message) {
  const { pan, tilt, roll, place } = poseOf(message)!;
  return [pan, tilt, roll, ...(place ?? [])].map((each) => Math.round(each * 100) / 100 + 0);
}

/** R = Rz(pan) Ry(tilt) [°]. */
function turn(pan: number, tilt: number): number[][] {
  const [p, t] = [(pan * Math.PI) / 180, (tilt * Math.PI) / 180];
  const [cp, sp, ct, st] = [Math.cos(p), Math.sin(p), Math.cos(t), Math.sin(t)];
  return [
    [cp * ct, -sp, cp * st, 0],
    [sp * ct, cp, sp * st, 0],
    [-st, 0, ct, 1.2],
  ];
}

test("a head that looks left and down, and stands above the ground", () => {
  assert.deepEqual(
    rounded(transformation(turn(12, 3), Coord.robot, Coord.head)),
    [12, 3, 0, 0, 0, 1.2],
  );
});

test("a camera on the head looks ahead: z forward, x right, y down", () => {
  const eye = [
    [0, 0, 1, 0.06],
    [-1, 0, 0, 0.05],
    [0, -1, 0, 0],
  ];
  assert.deepEqual(
    rounded(transformation(eye, Coord.head, Coord.left_eye)),
    [0, 0, 0, 0.06, 0.05, 0],
  );
});

test("a frame without a number has the axes of the other", () => {
  const ahead = [
    [1, 0, 0, 0],
    [0, 1, 0, 0],
    [0, 0, 1, 2],
  ];
  assert.deepEqual(rounded(transformation(ahead, Coord.left_eye, 100)), [0, 0, 0, 2, 0, 0]);
  assert.deepEqual(rounded(transformation(ahead, 0, 0)), [0, 0, 0, 0, 0, 2]);
});

test("a rotation is roll, tilt, pan, and a roll to the right is positive", () => {
  const kind = { type: "rotation", components: 3, scalar: "f64", encoding: "text" } as const;
  const elements = Float64Array.of(0, -0.1, Math.PI / 2);
  const message = { header: headerOf(kind, 1, 1, { coord: Coord.gaze }), elements };
  assert.deepEqual(rounded(message), [90, -5.73, 0]);
  const [c, s] = [Math.cos(0.1), Math.sin(0.1)];
  const rolled = [
    [1, 0, 0, 0],
    [0, c, -s, 0],
    [0, s, c, 0],
  ];
  assert.equal(rounded(transformation(rolled, Coord.robot, Coord.head))[2], 5.73);
});

test("angles and places in words", () => {
  assert.equal(angleText(12.34, "left", "right"), "12.3° left");
  assert.equal(angleText(-3, "down", "up"), "3.0° up");
  assert.equal(angleText(-0.01, "down", "up"), "0.0°");
  assert.equal(placeText([0.06, -0.05, 0]), "0.06 m forward, 0.05 m right");
  assert.equal(placeText([0, 0.001, 0]), "");
});
