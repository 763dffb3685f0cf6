// SPDX-License-Identifier: Apache-2.0
// Positions, poses and point clouds in space, among the frames of the graph. Loaded when needed.
import {
  AmbientLight,
  AxesHelper,
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  Color,
  DirectionalLight,
  Group,
  Line,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  Points,
  PointsMaterial,
  Scene as ThreeScene,
  SphereGeometry,
  Sprite,
  SpriteMaterial,
  WebGLRenderer,
  type Object3D,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { Coord, numbersOf, parseHeader, type Header, type Message, type Numbers } from "../mtp";
import type { Arrival } from "../server";
import { h } from "../shell/h";
import { colour, onTheme } from "../shell/theme";
import { framesOf, type Frame } from "./frames";
import { Sight } from "./room";
import type { Source, Surroundings, View, ViewHost } from "./view";

const trailLength = 500; // positions
const cloudWidth = 320; // elements in a row that a cloud is asked for

/** A scene with the graph's frames, and what streams put into it. */
export class Scene {
  readonly element: HTMLElement;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new ThreeScene();
  private readonly root = new Group();
  private readonly camera = new PerspectiveCamera(50, 1, 0.02, 200);
  private readonly controls: OrbitControls;
  private readonly frames = new Map<string, Group>();
  private readonly byCoord = new Map<number, Group>();
  private readonly labels: Object3D[] = [];
  private readonly layers = new Map<string, Layer>();
  private readonly sources: Source[] = [];
  private readonly observer: ResizeObserver;
  private readonly sight: Sight;
  private readonly endTheme: () => void;
  private readonly grid = floor();
  private isWaiting = false;
  private isClosed = false;

  constructor(private readonly surroundings: Surroundings) {
    this.renderer = new WebGLRenderer({ antialias: true });
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute(
      "aria-label",
      "Frames and positions in space; drag to turn, wheel to come closer, arrow keys to shift",
    );
    this.element = h("div", { class: "scene-view" }, canvas);
    this.root.add(this.grid);
    const sun = new DirectionalLight(0xffffff, 2);
    sun.position.set(-3, 2, 5);
    this.scene.add(this.root, new AmbientLight(0xffffff, 1.2), sun);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.listenToKeyEvents(canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.look();
    this.addFrames(framesOf(surroundings.session?.frames ?? ""));
    this.sight = new Sight(this.element);
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(this.element);
    this.endTheme = onTheme(() => {
      this.scene.background = new Color(colour("surface"));
      this.grid.material.color = new Color(colour("line"));
      this.draw();
    });
  }

  /** Looks over the head's shoulder, as at the beginning. */
  look(): void {
    this.camera.position.set(-0.9, 0.7, 1.8);
    this.controls.target.set(1.5, 0, 0.9);
    this.controls.update();
    this.draw();
  }

  showNames(shown: boolean): void {
    for (const label of this.labels) label.visible = shown;
    this.draw();
  }

  show(name: string, message: Message, sent: Header): void {
    let layer = this.layers.get(name);
    if (!layer || !layer.fits(message.header)) {
      layer?.remove();
      layer = layerOf(message.header);
      if (!layer) return;
      this.layers.set(name, layer);
    }
    const frame = this.frameOf(sent);
    if (layer.object.parent !== frame) frame.add(layer.object);
    layer.show(message);
    this.draw();
  }

  remove(name: string): void {
    this.layers.get(name)?.remove();
    this.layers.delete(name);
    this.draw();
  }

  close(): void {
    this.isClosed = true;
    for (const source of this.sources) source.close();
    for (const layer of this.layers.values()) layer.remove();
    this.observer.disconnect();
    this.sight.close();
    this.endTheme();
    this.controls.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  private frameOf(header: Header): Group {
    const coord = header.type === "transformation" ? Math.floor(header.coord / 1000) : header.coord;
    const frame = this.byCoord.get(coord);
    if (frame) return frame;
    // A rotation that is in no frame here, as of a person's head, is shown at the robot's.
    return (header.type === "rotation" && this.byCoord.get(Coord.robot)) || this.root;
  }

  private addFrames(frames: readonly Frame[]): void {
    for (const frame of frames) {
      const group = new Group();
      (this.frames.get(frame.parent) ?? this.root).add(group);
      this.frames.set(frame.name, group);
      if (frame.coord > 0) this.byCoord.set(frame.coord, group);
      if (frame.fixed) {
        group.position.set(...frame.fixed.translation);
        group.quaternion.set(...frame.fixed.quaternion);
      } else {
        group.matrixAutoUpdate = false;
      }
      group.add(new AxesHelper(0.08));
      const label = labelOf(frame.name);
      this.labels.push(label);
      group.add(label);
      if (frame.name === "head") group.add(headBody());
      if (frame.name.endsWith("_eye") && frame.name !== "cyclopean_eye") group.add(eyeBody());
    }
    this.follow(frames.filter(({ movedBy }) => movedBy !== undefined));
  }

  /** Moves frames as their outputs say. */
  private follow(frames: readonly Frame[]): void {
    for (const port of new Set(frames.map(({ movedBy }) => movedBy!))) {
      const moved = frames.filter(({ movedBy }) => movedBy === port);
      const source = this.surroundings.open(port);
      this.sources.push(source);
      source.on("message", async ({ message }) => {
        const { coord } = message.header;
        const from = coord % 1000;
        const frame =
          moved.find((each) => each.coord > 0 && each.coord === from) ??
          moved.find((each) => each.coord === 0 || coord === 0);
        const group = frame && this.frames.get(frame.name);
        if (group) setMatrix(group, message);
        await this.draw();
      });
    }
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.element;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.renderer.setSize(clientWidth, clientHeight);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /** Draws with the next frame of the screen, once however often it is called before. */
  private async draw(): Promise<void> {
    if (this.isWaiting) return;
    this.isWaiting = true;
    await new Promise(requestAnimationFrame);
    await this.sight?.seen();
    this.isWaiting = false;
    if (!this.isClosed) this.renderer.render(this.scene, this.camera);
  }
}

/** What a stream puts into the scene. */
interface Layer {
  readonly object: Object3D;
  fits(header: Header): boolean;
  show(message: Message): void;
  remove(): void;
}

function layerOf({ type }: Header): Layer | undefined {
  if (type === "vector_field") return new CloudLayer();
  if (type === "position") return new PositionsLayer();
  if (type === "rotation" || type === "transformation") return new PoseLayer(type);
  return undefined;
}

/** Points with x, y, z [m] and, where there are six components, red, green, blue [0, 1]. */
class CloudLayer implements Layer {
  private readonly geometry = new BufferGeometry();
  private readonly material = new PointsMaterial({ size: 0.012, vertexColors: true });
  readonly object = new Points(this.geometry, this.material);

  fits(header: Header): boolean {
    return header.type === "vector_field";
  }

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

  remove(): void {
    this.object.removeFromParent();
    this.geometry.dispose();
    this.material.dispose();
  }
}

type Array3 = BufferAttribute["array"];

/** Copies the points that are known; returns how many. */
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

/** Linear light of an sRGB component, about. */
function linear(value: number): number {
  return value * value;
}

/** Positions as balls, and the way of a single one as a line. */
class PositionsLayer implements Layer {
  readonly object = new Group();
  private readonly ball = new SphereGeometry(0.03, 16, 12);
  private readonly material = new MeshLambertMaterial({ color: colour("series-2") });
  private readonly trail = new BufferGeometry();
  private readonly trailMaterial = new LineBasicMaterial({ color: colour("series-2") });
  private readonly way: number[] = [];
  private readonly balls: Mesh[] = [];

  constructor() {
    const line = new Line(this.trail, this.trailMaterial);
    line.frustumCulled = false;
    this.object.add(line);
  }

  fits(header: Header): boolean {
    return header.type === "position";
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

  remove(): void {
    this.object.removeFromParent();
    for (const each of [this.ball, this.material, this.trail, this.trailMaterial]) each.dispose();
  }
}

/** A rotation or a pose as three axes. */
class PoseLayer implements Layer {
  readonly object = new Group();
  private readonly axes = new AxesHelper(0.3);

  constructor(private readonly type: string) {
    this.object.add(this.axes);
  }

  fits(header: Header): boolean {
    return header.type === this.type;
  }

  show(message: Message): void {
    const numbers = numbersOf(message);
    if (numbers.length === 0) return;
    if (this.type === "transformation") setMatrix(this.object, message);
    else this.object.rotation.set(numbers[0]!, numbers[1]!, numbers[2]!, "ZYX");
  }

  remove(): void {
    this.object.removeFromParent();
    this.axes.dispose();
  }
}

/** Places an object by a transformation 4 × 4, row by row. */
function setMatrix(object: Object3D, message: Message): void {
  const { width, height } = message.header;
  if (message.header.type !== "transformation" || width !== 4 || height !== 4) return;
  object.matrixAutoUpdate = false;
  object.matrix = new Matrix4().fromArray(Array.from(numbersOf(message))).transpose();
  object.matrixWorldNeedsUpdate = true;
}

/** Squares of half a metre on the ground, each side a line of its own so that none is too long. */
function floor(): LineSegments<BufferGeometry, LineBasicMaterial> {
  const ends: number[] = [];
  for (let i = -12; i <= 12; ++i) {
    for (let j = -12; j < 12; ++j) {
      ends.push(i / 2, j / 2, 0, i / 2, (j + 1) / 2, 0, j / 2, i / 2, 0, (j + 1) / 2, i / 2, 0);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(ends), 3));
  return new LineSegments(geometry, new LineBasicMaterial());
}

/** The head, drawn simply: x forward, y left, z up. */
function headBody(): Object3D {
  const material = new MeshLambertMaterial({ color: 0x8c9aa8, transparent: true, opacity: 0.85 });
  const skull = new Mesh(new BoxGeometry(0.09, 0.17, 0.13), material);
  skull.position.set(-0.01, 0, 0.05);
  const neck = new Mesh(new BoxGeometry(0.05, 0.05, 0.1), material);
  neck.position.set(-0.01, 0, -0.06);
  return new Group().add(skull, neck);
}

/** An eye: a ball, and what it sees as a pyramid; z forward, x right, y down. */
function eyeBody(): Object3D {
  const ball = new Mesh(
    new SphereGeometry(0.022, 16, 12),
    new MeshLambertMaterial({ color: 0x20262c }),
  );
  const [x, y, z] = [0.1, 0.075, 0.15];
  const corners = [
    [-x, -y, z],
    [x, -y, z],
    [x, y, z],
    [-x, y, z],
  ];
  const lines = corners.flatMap((corner, i) => [
    0,
    0,
    0,
    ...corner,
    ...corner,
    ...corners[(i + 1) % 4]!,
  ]);
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(lines), 3));
  const pyramid = new LineSegments(geometry, new LineBasicMaterial({ color: 0x6aa0d8 }));
  return new Group().add(ball, pyramid);
}

function labelOf(text: string): Object3D {
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("2d")!;
  const font = "28px system-ui, sans-serif";
  context.font = font;
  canvas.width = Math.ceil(context.measureText(text).width) + 12;
  canvas.height = 40;
  context.font = font;
  context.fillStyle = "rgb(20 28 36 / 75%)";
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.fillStyle = "#fff";
  context.fillText(text, 6, 29);
  const material = new SpriteMaterial({
    map: new CanvasTexture(canvas),
    depthTest: false,
    sizeAttenuation: false,
  });
  const sprite = new Sprite(material);
  sprite.scale.set((0.03 * canvas.width) / canvas.height, 0.03, 1);
  sprite.center.set(-0.1, -0.3);
  return sprite;
}

/** Buttons of a scene. */
export function sceneTools(scene: Scene): HTMLElement[] {
  const names = h("button", { "aria-pressed": "true", title: "Names of the frames" }, "Names");
  names.onclick = () => {
    const shown = names.getAttribute("aria-pressed") !== "true";
    names.setAttribute("aria-pressed", String(shown));
    scene.showNames(shown);
  };
  return [names, h("button", { onclick: () => scene.look() }, "Reset view")];
}

/** One stream in the scene. */
export class SceneView implements View {
  readonly element: HTMLElement;
  readonly tools: readonly HTMLElement[];
  private readonly scene: Scene;

  constructor({ source, surroundings }: ViewHost) {
    this.scene = new Scene(surroundings);
    this.element = this.scene.element;
    this.tools = sceneTools(this.scene);
    source.setWidth(cloudWidth);
  }

  show({ message }: Arrival, sent: Header): void {
    this.scene.show("stream", message, sent);
  }

  close(): void {
    this.scene.close();
  }
}

/** Adds a live stream to a scene; returns what takes it out. */
export function addStream(
  scene: Scene,
  surroundings: Surroundings,
  port: string,
  problem: (text: string) => void,
): () => void {
  const source = surroundings.open(port);
  let sent: Header | undefined;
  source.setWidth(cloudWidth);
  source.on("header", (line) => (sent = parseHeader(line.trim(), 0, Infinity)));
  source.on("problem", (text) => text && problem(text));
  source.on("message", async ({ message }: Arrival) => {
    scene.show(port, message, sent ?? message.header);
    await new Promise(requestAnimationFrame);
  });
  return () => {
    source.close();
    scene.remove(port);
  };
}
