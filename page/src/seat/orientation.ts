// SPDX-License-Identifier: Apache-2.0
// The orientation of a person's head, from device sensors. Pure; angles in rad.

/** Roll about x (forward), pitch about y (left), yaw about z (up): R = Rz(yaw) Ry(pitch) Rx(roll). */
export interface Angles {
  readonly roll: number;
  readonly pitch: number;
  readonly yaw: number;
}

/** Rows of a rotation matrix. */
type Matrix = readonly (readonly [number, number, number])[];

/** Axes of a body (x forward, y left, z up) in those of a screen (x right, y up, z to the person). */
const screenFromBody: Matrix = [
  [0, -1, 0],
  [0, 0, 1],
  [-1, 0, 0],
];

const degree = Math.PI / 180;

function product(a: Matrix, b: Matrix): Matrix {
  return a.map((row) => {
    const at = (column: number): number =>
      row[0] * b[0]![column]! + row[1] * b[1]![column]! + row[2] * b[2]![column]!;
    return [at(0), at(1), at(2)];
  });
}

function transpose(m: Matrix): Matrix {
  return [0, 1, 2].map((i) => [m[0]![i]!, m[1]![i]!, m[2]![i]!]);
}

/** A turn about the x axis (0), y (1) or z (2). */
function about(axis: 0 | 1 | 2, angle: number): Matrix {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
  const m = [0, 1, 2].map((row) => [0, 1, 2].map((column) => Number(row === column)));
  [m[i]![i], m[i]![j], m[j]![i], m[j]![j]] = [c, -s, s, c];
  return m as unknown as Matrix;
}

function anglesOf(m: Matrix): Angles {
  return {
    roll: Math.atan2(m[2]![1], m[2]![2]),
    pitch: Math.asin(Math.max(-1, Math.min(1, -m[2]![0]))),
    yaw: Math.atan2(m[1]![0], m[0]![0]),
  };
}

/**
 * Orientation of the view direction of a phone's back.
 *
 * @param alpha, beta, gamma  of DeviceOrientationEvent [degree].
 * @param screen  angle of screen.orientation [degree].
 */
export function anglesOfDevice(alpha: number, beta: number, gamma: number, screen: number): Angles {
  const device = [about(2, alpha * degree), about(0, beta * degree), about(1, gamma * degree)];
  return anglesOf([...device, about(2, -screen * degree), screenFromBody].reduce(product));
}

/** Orientation of a headset, from a quaternion in a space with y up. */
export function anglesOfHeadset(q: { x: number; y: number; z: number; w: number }): Angles {
  const { x, y, z, w } = q;
  const headset: Matrix = [
    [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
  ];
  return anglesOf([transpose(screenFromBody), headset, screenFromBody].reduce(product));
}

/** Angles of a transformation from a frame of a body to another, 4 × 4, row by row. */
export function anglesOfPose(numbers: ArrayLike<number>): Angles {
  const row = (i: number): [number, number, number] => [
    numbers[4 * i]!,
    numbers[4 * i + 1]!,
    numbers[4 * i + 2]!,
  ];
  return anglesOf([row(0), row(1), row(2)]);
}

/** Angles since a zero; each from -π to π. */
export function since(zero: Angles, now: Angles): Angles {
  return {
    roll: wrap(now.roll - zero.roll),
    pitch: wrap(now.pitch - zero.pitch),
    yaw: wrap(now.yaw - zero.yaw),
  };
}

function wrap(angle: number): number {
  return angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
}
