// SPDX-License-Identifier: Apache-2.0
// The messages for ROS 2, decoded by a library that is not ours: texts, values, and the same bytes
// when it writes what it has read.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { join } from "node:path";
import { test } from "node:test";
import { parse } from "@foxglove/rosmsg";
import { ros2jazzy } from "@foxglove/rosmsg-msgs-common";
import { MessageReader, MessageWriter } from "@foxglove/rosmsg2-serialization";

const program = join(process.env.HC_BUILD, "tests/programs/ros_samples");
const { stdout, status } = spawnSync(program, ["500"], { encoding: "utf8", maxBuffer: 1 << 28 });
assert.equal(status, 0);
const types = new Map(
  stdout
    .trim()
    .split("\n")
    .map((line) => JSON.parse(line))
    .map((type) => [type.type, type]),
);

const stamp = { sec: 1763683200, nanosec: 123456789 };
const header = (frame_id) => ({ stamp, frame_id });
const bytes = (...list) => Uint8Array.from(list);
const below = (count) => Array.from({ length: count }, (_, i) => i + 1);
const field = (name, i) => ({ name, offset: 4 * i, datatype: 7, count: 1 });
const joint = {
  header: header("robot"),
  child_frame_id: "head",
  transform: { translation: { x: 1, y: 2, z: 3 }, rotation: { x: 0, y: 0, z: 0.6, w: 0.8 } },
};
const values = {
  "sensor_msgs/msg/Image": {
    header: header("left_eye"),
    height: 2,
    width: 3,
    encoding: "rgb8",
    is_bigendian: 0,
    step: 9,
    data: bytes(...below(18)),
  },
  "sensor_msgs/msg/CompressedImage": {
    header: header("right_eye"),
    format: "jpeg",
    data: bytes(...below(18)),
  },
  "sensor_msgs/msg/PointCloud2": {
    header: header("left_eye"),
    height: 2,
    width: 2,
    fields: ["x", "y", "z", "r", "g", "b"].map(field),
    is_bigendian: false,
    point_step: 24,
    row_step: 48,
    data: new Uint8Array(Float32Array.from(below(24)).buffer),
    is_dense: false,
  },
  "sensor_msgs/msg/CameraInfo": {
    header: header("left_eye"),
    height: 600,
    width: 800,
    distortion_model: "plumb_bob",
    d: Float64Array.from([0, 0, 0, 0, 0]),
    k: Float64Array.from([1, 0, 3, 0, 2, 4, 0, 0, 1]),
    r: Float64Array.from([1, 0, 0, 0, 1, 0, 0, 0, 1]),
    p: Float64Array.from([1, 0, 3, 0, 0, 2, 4, 0, 0, 0, 1, 0]),
    binning_x: 0,
    binning_y: 0,
    roi: { x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: false },
  },
  "geometry_msgs/msg/PoseStamped": {
    header: header("head"),
    pose: { position: { x: 1, y: 2, z: 3 }, orientation: { x: 0, y: 0, z: 0, w: 1 } },
  },
  "geometry_msgs/msg/Twist": {
    linear: { x: 1, y: 2, z: 3 },
    angular: { x: 4, y: 5, z: 6 },
  },
  "tf2_msgs/msg/TFMessage": { transforms: [joint, joint] },
  "sensor_msgs/msg/JointState": {
    header: header(""),
    name: ["roll", "tilt", "pan"],
    position: Float64Array.from([1, 2, 3]),
    velocity: Float64Array.from([4, 5, 6]),
    effort: new Float64Array(),
  },
  "std_msgs/msg/String": { data: "\u0001\u0002\u0003\u0004\u0005" },
  "foxglove_msgs/msg/RawAudio": {
    timestamp: stamp,
    data: new Uint8Array(Int16Array.from(below(6)).buffer),
    format: "pcm-s16",
    sample_rate: 16000,
    number_of_channels: 2,
  },
  "rcl_interfaces/msg/Log": {
    stamp,
    level: 30,
    name: "eyes",
    msg: "it is dark",
    file: "",
    function: "",
    line: 0,
  },
  "hypercolumn_msgs/msg/Matrix": {
    header: "1 0 0 0 8 1763683200123456789 120101 0 0 3 1",
    offset: 0,
    size: 0,
    elements: bytes(1, 2, 3),
  },
};
const arrays = {
  UInt8: Uint8Array,
  Int8: Int8Array,
  UInt16: Uint16Array,
  Int16: Int16Array,
  UInt32: Uint32Array,
  Int32: Int32Array,
  UInt64: BigUint64Array,
  Int64: BigInt64Array,
  Float32: Float32Array,
  Float64: Float64Array,
};
for (const [name, List] of Object.entries(arrays))
  values[`std_msgs/msg/${name}MultiArray`] = {
    layout: {
      dim: [
        { label: "height", size: 2, stride: 12 },
        { label: "width", size: 3, stride: 6 },
        { label: "components", size: 2, stride: 2 },
      ],
      data_offset: 0,
    },
    data: List.from(below(12).map(name.endsWith("64") && !name.startsWith("F") ? BigInt : Number)),
  };

/** Plain values, so that typed arrays of any base are compared by what they hold. */
function plain(value) {
  if (ArrayBuffer.isView(value)) return [value.constructor.name, ...value];
  if (Array.isArray(value)) return value.map(plain);
  if (typeof value === "object" && value !== null)
    return Object.fromEntries(Object.entries(value).map(([key, each]) => [key, plain(each)]));
  return value;
}

/** Names and types of the members that are no constants. */
function members({ definitions }) {
  return definitions
    .filter((each) => !each.isConstant)
    .map(({ name, type, isArray, arrayLength }) => [name, type, isArray ?? false, arrayLength]);
}

test("every type has values here", () => {
  assert.deepEqual([...types.keys()].sort(), Object.keys(values).sort());
});

for (const [name, { text, messages }] of types) {
  const definitions = parse(text, { ros2: true });

  test(`${name}: its text is that of ROS`, () => {
    for (const [i, definition] of definitions.entries()) {
      const short = i === 0 ? name.replace("/msg/", "/") : definition.name;
      if (/^(hypercolumn|foxglove)_msgs/.test(short)) continue;
      assert.ok(ros2jazzy[short], `ROS has ${short}`);
      assert.deepEqual(members(definition), members(ros2jazzy[short]), short);
    }
  });

  test(`${name}: values`, () => {
    const read = new MessageReader(definitions).readMessage(Buffer.from(messages[0], "hex"));
    assert.deepEqual(plain(read), plain(values[name]));
  });

  test(`${name}: what is written again is the same bytes`, () => {
    const reader = new MessageReader(definitions);
    const writer = new MessageWriter(definitions);
    for (const message of messages) {
      const again = writer.writeMessage(reader.readMessage(Buffer.from(message, "hex")));
      assert.equal(Buffer.from(again).toString("hex"), message);
    }
  });
}
