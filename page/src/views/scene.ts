// SPDX-License-Identifier: Apache-2.0
// Positions, poses and point clouds in 3D, with the frames of the graph. Loaded on demand.
import {
  AmbientLight,
  AxesHelper,
  Color,
  DirectionalLight,
  Group,
  PerspectiveCamera,
  Scene as ThreeScene,
  WebGLRenderer,
  type Object3D,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { Coord, sentHeader, type Header, type Message } from "../mtp";
import type { Arrival } from "../server";
import { button, h } from "../shell/h";
import { colour, onTheme } from "../shell/theme";
import { eyeBody, floor, headBody, labelOf } from "./bodies";
import { framesOf, type Frame } from "./frames";
import { layerOf, removeLayer, setMatrix, type Layer } from "./layers";
import { Sight } from "./room";
import type { Source, Surroundings, View, ViewHost } from "./view";

const cloudWidth = 320; // requested elements in a row of a cloud

/** A 3D scene with the graph's frames and the contents of streams. */
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
  private readonly sight: Sight;
  private readonly ends: readonly (() => void)[];
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
    this.element = h("div.scene-view", canvas);
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
    const observer = new ResizeObserver(() => this.resize());
    observer.observe(this.element);
    const endTheme = onTheme(() => {
      this.scene.background = new Color(colour("surface"));
      this.grid.material.color = new Color(colour("line"));
      this.draw();
    });
    this.ends = [() => observer.disconnect(), () => this.sight.close(), endTheme];
  }

  /** Resets the view: from behind the head. */
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
    if (layer?.type !== message.header.type) {
      if (layer) removeLayer(layer);
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
    const layer = this.layers.get(name);
    if (layer) removeLayer(layer);
    this.layers.delete(name);
    this.draw();
  }

  close(): void {
    this.isClosed = true;
    for (const source of this.sources) source.close();
    for (const layer of this.layers.values()) removeLayer(layer);
    for (const end of this.ends) end();
    this.controls.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  private frameOf(header: Header): Group {
    const coord = header.type === "transformation" ? Math.floor(header.coord / 1000) : header.coord;
    const frame = this.byCoord.get(coord);
    if (frame) return frame;
    // A rotation without a frame in this graph, e.g. of a person's head, is shown at the robot.
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

  /** Moves frames by their outputs. */
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

  /** Draws once with the next screen frame, however often it is called. */
  private async draw(): Promise<void> {
    if (this.isWaiting) return;
    this.isWaiting = true;
    await new Promise(requestAnimationFrame);
    await this.sight?.seen();
    this.isWaiting = false;
    if (!this.isClosed) this.renderer.render(this.scene, this.camera);
  }
}

/** Buttons of a scene. */
export function sceneTools(scene: Scene): HTMLElement[] {
  let shown = true;
  const toggle = () => {
    shown = !shown;
    names.setAttribute("aria-pressed", String(shown));
    scene.showNames(shown);
  };
  const names = button("Names", toggle, { "aria-pressed": "true", title: "Names of the frames" });
  return [names, button("Reset view", () => scene.look())];
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

/** Adds a live stream to a scene; returns a function that removes it. */
export function addStream(
  scene: Scene,
  surroundings: Surroundings,
  port: string,
  problem: (text: string) => void,
): () => void {
  const source = surroundings.open(port);
  let sent: Header | undefined;
  source.setWidth(cloudWidth);
  source.on("header", (line) => (sent = sentHeader(line)));
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
