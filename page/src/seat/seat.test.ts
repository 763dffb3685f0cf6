// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { sentHeader } from "../mtp";
import type { GraphState } from "../server";
import { eyePairs, labelsOf } from "../eyes";
import { headOutput } from "./gaze";
import { Latency } from "./latency";
import { anglesOfDevice, anglesOfHeadset, anglesOfPose, since, type Angles } from "./orientation";
import { pixelAt, placesOf } from "./places";
import { Keys, pushOfGamepads, Stick, withoutDeadZone } from "./steering";
import { WallClock } from "./wall_clock";

const degree = Math.PI / 180;

function nearly(angles: Angles, roll: number, pitch: number, yaw: number): void {
  const off = since(angles, { roll: roll * degree, pitch: pitch * degree, yaw: yaw * degree });
  const text = `${JSON.stringify(angles)} is not ${roll}, ${pitch}, ${yaw} degree`;
  assert.ok(Math.max(...Object.values(off).map(Math.abs)) < 1e-9, text);
}

test("a phone that is held upright and turned", () => {
  const zero = anglesOfDevice(0, 90, 0, 0);
  // About the vertical, counter-clockwise from above: to the left.
  nearly(since(zero, anglesOfDevice(30, 90, 0, 0)), 0, 0, 30);
  nearly(since(zero, anglesOfDevice(350, 90, 0, 0)), 0, 0, -10);
  // Its top tilted away from the person: its back faces down.
  nearly(since(zero, anglesOfDevice(0, 70, 0, 0)), 0, 20, 0);
});

test("a phone that lies across looks where it looked", () => {
  const upright = anglesOfDevice(0, 90, 0, 0);
  // Rotated 90° to the left about its line of sight; the browser rotated the picture back.
  const across = anglesOfDevice(90, 0, -90, 90);
  nearly(since({ ...upright, yaw: 0 }, { ...across, yaw: 0 }), 0, 0, 0);
  const lower = anglesOfDevice(90, 0, -70, 90);
  assert.ok(Math.abs(since(across, lower).pitch - 20 * degree) < 1e-9);
});

test("a headset that turns left, and looks down", () => {
  const about = (x: number, y: number, z: number, angle: number) => {
    const s = Math.sin((angle * degree) / 2);
    return { x: x * s, y: y * s, z: z * s, w: Math.cos((angle * degree) / 2) };
  };
  nearly(anglesOfHeadset(about(0, 1, 0, 25)), 0, 0, 25);
  nearly(anglesOfHeadset(about(1, 0, 0, -15)), 0, 15, 0);
  nearly(anglesOfHeadset(about(0, 0, 1, -10)), 10, 0, 0);
});

test("the angles of a pose", () => {
  const [c, s] = [Math.cos(0.3), Math.sin(0.3)];
  const pose = [c, -s, 0, 1, s, c, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1];
  nearly(anglesOfPose(pose), 0, 0, 0.3 / degree);
  const frames = "robot 2 world 0 0 1.2 0 0 0 1; head 3 robot head_neck.pose 57";
  assert.equal(headOutput(frames), "head_neck.pose");
  assert.equal(headOutput("robot 2 world 0 0 1.2 0 0 0 1"), undefined);
});

test("hands on the stick add up to its end", () => {
  const stick = new Stick();
  stick.set("pad", { left: 0.7, down: -0.2 });
  stick.set("keys", { left: 1, down: 0 });
  assert.deepEqual(stick.push, { left: 1, down: -0.2 });
  stick.set("keys", { left: 0, down: 0 });
  assert.deepEqual(stick.push, { left: 0.7, down: -0.2 });
  stick.release();
  assert.deepEqual(stick.push, { left: 0, down: 0 });
});

test("keys push by their places, opposite ones not at all", () => {
  const keys = new Keys();
  assert.equal(keys.press("KeyQ"), false);
  assert.ok(keys.press("ArrowLeft") && keys.press("KeyS"));
  assert.deepEqual(keys.push(false), { left: 1, down: 1 });
  keys.press("KeyD");
  assert.deepEqual(keys.push(true), { left: 0, down: 0.3 });
});

test("a gamepad's dead zone is 0.1, and its right is the stick's -left", () => {
  assert.equal(withoutDeadZone(0.1), 0);
  assert.equal(withoutDeadZone(-1), -1);
  assert.equal(withoutDeadZone(NaN), 0);
  const pad = (axes: number[]) => ({ axes, connected: true });
  assert.deepEqual(pushOfGamepads([null]), { left: 0, down: 0 });
  const push = pushOfGamepads([pad([0.05, 0, 0, 1]), pad([0.55, 0])]);
  assert.ok(Math.abs(push.left + 0.5) < 1e-9);
  assert.equal(push.down, 1);
});

test("a point of the canvas is a pixel of the sensor", () => {
  const canvas = { width: 1000, height: 600 };
  const sensor = { width: 800, height: 600 };
  const one = placesOf("left", { width: 400, height: 300 }, canvas);
  assert.deepEqual(pixelAt(one, { x: 100, y: 0 }, sensor), { side: "left", x: -0.5, y: -0.5 });
  assert.deepEqual(pixelAt(one, { x: 500, y: 300 }, sensor), { side: "left", x: 399.5, y: 299.5 });
  assert.equal(pixelAt(one, { x: 50, y: 300 }, sensor), undefined);
  const two = placesOf("side by side", { width: 400, height: 300 }, canvas);
  assert.equal(pixelAt(two, { x: 750, y: 300 }, sensor)?.side, "right");
  const { width, height } = sentHeader("1 7 0 0 8 0 30301 1 7 800 600\n")!;
  assert.deepEqual({ width, height }, sensor);
  assert.equal(sentHeader("nothing"), undefined);
});

test("motion to photon is to the first later image that changed more than before", () => {
  const latency = new Latency();
  const image = (grey: number, sensed: number) => ({
    thumbnail: new Uint8Array(4).fill(grey),
    sensed,
    arrived: sensed + 30,
    decoded: sensed + 35,
    drawn: sensed + 40,
  });
  [100, 101, 100].forEach((grey, i) => latency.shown(image(grey, 1000 + 50 * i)));
  latency.command(1120);
  latency.shown(image(160, 1115)); // taken before the command
  latency.shown(image(101, 1150)); // varies as before
  latency.shown(image(120, 1200));
  assert.deepEqual(latency.measurements, [
    { total: 120, sensed: 80, arrived: 30, decoded: 5, drawn: 5 },
  ]);
  latency.command(1250); // the head is not at rest
  latency.shown(image(200, 1300));
  assert.equal(latency.measurements.length, 1);
  assert.equal(latency.median, 120);
});

test("motion before the first command hides no later one", () => {
  const latency = new Latency();
  let [grey, moment] = [100, 0];
  const show = (count: number, step: number) => {
    for (let i = 0; i < count; ++i) {
      [grey, moment] = [grey + step, moment + 50];
      const thumbnail = new Uint8Array(4).fill(grey);
      latency.shown({
        thumbnail,
        sensed: moment,
        arrived: moment,
        decoded: moment,
        drawn: moment,
      });
    }
  };
  show(8, 10); // another task moves the head
  latency.command(moment);
  show(4, 3); // too little to be told from that
  assert.equal(latency.measurements.length, 0);
  for (let i = 1; i <= 3; ++i) {
    show(12, 0);
    latency.command(moment);
    show(4, 3);
    assert.equal(latency.measurements.length, i);
  }
  latency.command(moment + 600);
  moment += 3000; // no image for longer than a measurement takes
  show(4, 3);
  assert.equal(latency.measurements.length, 3);
});

test("the wall clock, with fractions of a millisecond", () => {
  let [fine, wall] = [10, 1000];
  const clock = new WallClock(
    () => fine,
    () => wall,
  );
  [fine, wall] = [12.25, 1002];
  assert.equal(clock.now(), 1002.25);
  // The machine slept for two hours while its monotonic clock stood still.
  wall += 7_200_000;
  assert.equal(clock.now(), 7_201_002);
  fine += 0.5;
  assert.equal(clock.now(), 7_201_002.5);
  // Its clock is set back by a second.
  wall -= 1000;
  assert.equal(clock.now(), 7_200_002);
});

test("depths of both eyes are a pair in each coding", () => {
  const link = (from: string, to: string) => ({ from, to });
  const state = {
    modules: [
      { name: "eyes", program: "simulator" },
      { name: "depth", program: "/usr/bin/depth" },
    ],
    links: [link("eyes.left", "depth.left"), link("eyes.right", "depth.right")],
  } as unknown as GraphState;
  const pairs = eyePairs(state);
  const codings = (of: typeof pairs) => of.flatMap(({ coding }) => coding ?? []);
  assert.deepEqual(codings(pairs), ["colours", "relief", "fog"]);
  assert.deepEqual(
    [...labelsOf(pairs)],
    [
      ["eyes", "Camera"],
      ["depth", "Depth"],
    ],
  );
  const { left, right, raw, images } = pairs.at(-1)!;
  assert.deepEqual([left, right, raw], ["depth.depth", "depth.right_depth", false]);
  assert.deepEqual(images, ["eyes.left", "eyes.right"]);
  const alone = { ...state, links: state.links.slice(0, 1) };
  assert.deepEqual(codings(eyePairs(alone)), ["colours", "relief"]);
});
