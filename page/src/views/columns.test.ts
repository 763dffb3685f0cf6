// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { Coord, headerOf, type MatrixType } from "../mtp";
import { columnOf, columnsOf, quantityText, shown } from "./columns";

function columns(type: MatrixType, components: number, width: number, coord = 0, declared = [""]) {
  const kind = { type, components, scalar: "f64", encoding: "text" } as const;
  const header = headerOf(kind, width, 1, { coord });
  const names = columnsOf(header, declared.filter(Boolean));
  return names.map(({ name, unit }) => (unit ? `${name} [${unit}]` : name));
}

test("a declared column has a name and perhaps a unit", () => {
  assert.deepEqual(columnOf("age [s]"), { name: "age", unit: "s" });
  assert.deepEqual(columnOf("in focus"), { name: "in focus", unit: "" });
});

test("declared columns come before those of the type, and are repeated", () => {
  assert.deepEqual(columns("table", 1, 2, 0, ["mode", "age [s]"]), ["mode", "age [s]"]);
  assert.deepEqual(columns("position", 3, 1, 7, ["x [px]", "y [px]", "radius [px]"]), [
    "x [px]",
    "y [px]",
    "radius [px]",
  ]);
  assert.deepEqual(columns("table", 1, 4, 0, ["x [m]", "y"]), ["x 0 [m]", "y 0", "x 1 [m]", "y 1"]);
});

test("without a declaration the type and the coordinate system name the numbers", () => {
  assert.deepEqual(columns("position", 3, 1, Coord.left_image), ["x [px]", "y [px]", "size [px]"]);
  assert.deepEqual(columns("position", 6, 1, Coord.world).slice(2, 5), [
    "z [m]",
    "x velocity [m/s]",
    "y velocity [m/s]",
  ]);
  assert.deepEqual(columns("rotation", 3, 1, Coord.gaze), [
    "roll [rad]",
    "tilt [rad]",
    "pan [rad]",
  ]);
  assert.deepEqual(columns("rotation", 3, 1), ["roll [rad]", "pitch [rad]", "yaw [rad]"]);
  assert.deepEqual(columns("table", 1, 1), ["value"]);
  assert.deepEqual(columns("table", 1, 3), ["0", "1", "2"]);
  assert.deepEqual(columns("table", 2, 2), ["0.0", "0.1", "1.0", "1.1"]);
});

test("radians are shown in degrees", () => {
  const { unit, factor } = shown({ name: "pan", unit: "rad" });
  assert.equal(quantityText(-Math.PI * factor, unit), "−180°");
  assert.equal(shown({ name: "pan", unit: "rad/s" }).unit, "°/s");
  assert.equal(quantityText(1.23456, "m"), "1.235 m");
});
