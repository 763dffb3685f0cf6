// SPDX-License-Identifier: Apache-2.0
// The contents of a scene, from streams: clouds, positions, poses.
import {
  AxesHelper,
  BufferAttribute,
  BufferGeometry,
  Group,
  Line,
  LineBasicMaterial,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  Points,
  PointsMaterial,
  SphereGeometry,
  type Object3D,
} from "three";
import { numbersOf, type Header, type Message, type Numbers } from "../mtp";
import { colour } from "../shell/theme";

const trailLength = 500; // positions

/** The contents of a scene from one stream. */
export interface Layer {
  readonly object: Object3D;
  /** The type of its messages. */
  readonly type: Header["type"];
  show(message: Message): void;
  /** Objects in GPU memory. */
  readonly owned: readonly { dispose(): void }[];
}

export function removeLayer({ object, owned }: Layer): void {
  object.removeFromParent();
  for (const each of owned) each.dispose();
}

/** A layer for messages with this header; undefined: none. */
export function layerOf({ type }: Header): Layer | undefined {
  if (type === "vector_field") return new CloudLayer();
  if (type === "position") return new PositionsLayer();
  if (type === "rotation" || type === "transformation") return new PoseLayer(type);
  return undefined;
}

/** Points with x, y, z [m] and, with six components, red, green, blue [0, 1]. */
class CloudLayer implements Layer {
  private readonly geometry = new BufferGeometry();
  private readonly material = new PointsMaterial({ size: 0.012, vertexColors: true });
  readonly object = new Points(this.geometry, this.material);
  readonly type = "vector_field";
  readonly owned = [this.geometry, this.material];

  show(message: Message): void {
    const { components } = message.header;
    const numbers = numbersOf(message);
    const count = Math.floor(numbers.length / components);
    let places = this.geometry.getAttribute("position") as BufferAttribute | undefined;
    if (!places || places.count < count) {
      places = new BufferAttribute(new Float32Array(3 * count), 3);
      this.geometry.setAttribute("position", places);
      this.geometry.setAttribute("color", new BufferAttribute(new Float32Array(3 * count), 3));
    }
    const colours = this.geometry.getAttribute("color") as BufferAttribute;
    const used = fillCloud(numbers, components, places.array, colours.array);
    places.needsUpdate = true;
    colours.needsUpdate = true;
    this.geometry.setDrawRange(0, used);
    this.object.frustumCulled = false;
  }
}

type Array3 = BufferAttribute["array"];

/** Copies the known points; returns their number. */
function fillCloud(numbers: Numbers, components: number, places: Array3, colours: Array3): number {
  let to = 0;
  for (let from = 0; from + components <= numbers.length; from += components) {
    const [x, y, z] = [numbers[from]!, numbers[from + 1]!, numbers[from + 2]!];
    if (!(Number.isFinite(x) && Number.isFinite(y) && Number.isFinite(z))) continue;
    for (let i = 0; i < 3; ++i) {
      places[to + i] = numbers[from + i]!;
      colours[to + i] = components >= 6 ? linear(numbers[from + 3 + i]!) : 0.5;
    }
    to += 3;
  }
  return to / 3;
}

/** Approximate linear light of an sRGB component. */
function linear(value: number): number {
  return value * value;
}

/** Positions as balls, and the trail of a single one as a line. */
class PositionsLayer implements Layer {
  readonly type = "position";
  readonly object = new Group();
  private readonly ball = new SphereGeometry(0.03, 16, 12);
  private readonly material = new MeshLambertMaterial({ color: colour("series-2") });
  private readonly trail = new BufferGeometry();
  private readonly trailMaterial = new LineBasicMaterial({ color: colour("series-2") });
  readonly owned = [this.ball, this.material, this.trail, this.trailMaterial];
  private readonly way: number[] = [];
  private readonly balls: Mesh[] = [];

  constructor() {
    const line = new Line(this.trail, this.trailMaterial);
    line.frustumCulled = false;
    this.object.add(line);
  }

  show(message: Message): void {
    const { components } = message.header;
    const numbers = numbersOf(message);
    const count = Math.min(1000, numbers.length / components);
    while (this.balls.length < count) {
      const ball = new Mesh(this.ball, this.material);
      this.balls.push(ball);
      this.object.add(ball);
    }
    this.balls.forEach((ball, i) => {
      ball.visible = i < count;
      const at = i * components;
      if (i < count) ball.position.set(numbers[at]!, numbers[at + 1]!, numbers[at + 2]!);
    });
    if (count !== 1) return;
    this.way.push(numbers[0]!, numbers[1]!, numbers[2]!);
    if (this.way.length > 3 * trailLength) this.way.splice(0, 3);
    this.trail.setAttribute("position", new BufferAttribute(Float32Array.from(this.way), 3));
  }
}

/** A rotation or a pose as three axes. */
class PoseLayer implements Layer {
  readonly object = new Group();
  readonly owned = [new AxesHelper(0.3)];

  constructor(readonly type: "rotation" | "transformation") {
    this.object.add(...this.owned);
  }

  show(message: Message): void {
    const numbers = numbersOf(message);
    if (numbers.length === 0) return;
    if (this.type === "transformation") setMatrix(this.object, message);
    else this.object.rotation.set(numbers[0]!, numbers[1]!, numbers[2]!, "ZYX");
  }
}

/** Sets an object's pose to a 4 × 4 transformation, row by row. */
export function setMatrix(object: Object3D, message: Message): void {
  const { width, height } = message.header;
  if (message.header.type !== "transformation" || width !== 4 || height !== 4) return;
  object.matrixAutoUpdate = false;
  object.matrix = new Matrix4().fromArray(Array.from(numbersOf(message))).transpose();
  object.matrixWorldNeedsUpdate = true;
}
