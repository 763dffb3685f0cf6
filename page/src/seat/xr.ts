// SPDX-License-Identifier: Apache-2.0
// Telepresence in a headset: each eye sees the image of the robot's eye, in the direction in which the
// head looked then.
import {
  CanvasTexture,
  Group,
  LinearFilter,
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  SRGBColorSpace,
  WebGLRenderer,
} from "three";
import type { Side } from "../views/pairing";
import type { Picture } from "./eye";
import { anglesOfHeadset, since, type Angles } from "./orientation";
import type { Pictures } from "./picture";

/** Distance of the images [m]; their size follows from the camera's focal length. */
const distance = 4;

/** Between slow frames the last orientation is repeated at this period [ms] … */
const period = 40;
/** … for this time [ms]; later the headset has failed. */
const patience = 1000;

export interface XrOptions {
  /** Focal length of the cameras [px of the sensor]. */
  readonly focal: number;
  /** Called each frame with the headset's orientation relative to its zero. */
  turned(angles: Angles): void;
  /** The robot's orientation at a time [ns]; undefined: unknown. */
  gazeAt(time: bigint): Angles | undefined;
  ended(): void;
}

/** An eye's image on a plane visible only to this eye. */
class Quad {
  private readonly canvas = document.createElement("canvas");
  private texture?: CanvasTexture;
  private readonly material = new MeshBasicMaterial();
  readonly mesh = new Mesh(new PlaneGeometry(1, 1), this.material);
  picture?: Picture;

  /** @param layer  of three.js, 1: left eye, 2: right eye. */
  constructor(layer: number) {
    this.mesh.layers.set(layer);
    this.mesh.visible = false;
  }

  show(picture: Picture | undefined, focal: number): void {
    this.picture = picture;
    this.mesh.visible = picture !== undefined;
    if (!picture) return;
    const { width, height } = picture.bitmap;
    if (!this.texture || this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
      this.texture?.dispose();
      this.texture = new CanvasTexture(this.canvas);
      this.texture.colorSpace = SRGBColorSpace;
      this.texture.minFilter = LinearFilter;
      this.texture.generateMipmaps = false;
      this.material.map = this.texture;
      this.material.needsUpdate = true;
    }
    this.canvas.getContext("2d")?.drawImage(picture.bitmap, 0, 0);
    this.texture.needsUpdate = true;
    const scale = distance / focal;
    this.mesh.scale.set(picture.width * scale, picture.height * scale, 1);
  }

  dispose(): void {
    this.texture?.dispose();
    this.material.dispose();
    this.mesh.geometry.dispose();
  }
}

/** A session in a headset. */
export class XrView {
  private readonly renderer = new WebGLRenderer({ antialias: false });
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera();
  private readonly quads: Record<Side, Quad> = { left: new Quad(1), right: new Quad(2) };
  private readonly gaze = new Group();
  private readonly waiting: (() => void)[] = [];
  private zeroed?: Angles;
  private last?: { turned: Angles; at: number };
  private readonly timer = window.setInterval(() => this.repeat(), period);

  private constructor(
    private readonly session: XRSession,
    private readonly options: XrOptions,
  ) {
    this.gaze.rotation.order = "YXZ";
    for (const { mesh } of Object.values(this.quads)) {
      mesh.position.set(0, 0, -distance);
      this.gaze.add(mesh);
    }
    this.scene.add(this.gaze);
  }

  /** Errors: from the browser, without a headset or permission. */
  static async enter(options: XrOptions): Promise<XrView> {
    const xr = navigator.xr;
    if (!xr) throw new Error("This browser has no WebXR. Use the headset's browser.");
    const session = await xr.requestSession("immersive-vr");
    const view = new XrView(session, options);
    const { renderer } = view;
    renderer.xr.enabled = true;
    renderer.xr.setReferenceSpaceType("local");
    session.addEventListener("end", () => view.dispose());
    await renderer.xr.setSession(session);
    renderer.setAnimationLoop((_time, frame) => frame && view.frame(frame));
    return view;
  }

  /** Shows both eyes' images, or that of one: the other eye is dark. */
  show(pictures: Pictures): void {
    for (const side of ["left", "right"] as const)
      this.quads[side].show(pictures[side], this.options.focal);
  }

  /** Makes the current orientation straight ahead. */
  zero(): void {
    this.zeroed = undefined;
  }

  /** Calls back when the current images have been drawn. */
  nextFrame(drawn: () => void): void {
    this.waiting.push(drawn);
  }

  leave(): void {
    void this.session.end();
  }

  private frame(frame: XRFrame): void {
    const space = this.renderer.xr.getReferenceSpace();
    const pose = space && frame.getViewerPose(space);
    if (pose && this.session.visibilityState === "visible") {
      const { position, orientation } = pose.transform;
      const now = anglesOfHeadset(orientation);
      this.zeroed ??= now;
      const turned = since(this.zeroed, now);
      this.last = { turned, at: performance.now() };
      this.options.turned(turned);
      const picture = this.quads.left.picture ?? this.quads.right.picture;
      const gaze = (picture && this.options.gazeAt(picture.time)) ?? turned;
      this.gaze.position.set(position.x, position.y, position.z);
      // Body axes to WebXR axes: left is -x, forward is -z; angles are about fixed axes.
      const { roll, pitch, yaw } = this.zeroed;
      this.gaze.rotation.set(-(pitch + gaze.pitch), yaw + gaze.yaw, -(roll + gaze.roll));
    }
    this.renderer.render(this.scene, this.camera);
    for (const drawn of this.waiting.splice(0)) drawn();
  }

  private repeat(): void {
    const age = performance.now() - (this.last?.at ?? -Infinity);
    if (this.last && age > period && age < patience) this.options.turned(this.last.turned);
  }

  private dispose(): void {
    clearInterval(this.timer);
    this.renderer.setAnimationLoop(null);
    for (const quad of Object.values(this.quads)) quad.dispose();
    this.renderer.dispose();
    this.options.ended();
  }
}
