// SPDX-License-Identifier: Apache-2.0
// The robot and the ground in a scene, drawn simply.
import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshLambertMaterial,
  SphereGeometry,
  Sprite,
  SpriteMaterial,
  type Object3D,
} from "three";

/** A grid of 0.5 m on the ground, of short lines. */
export function floor(): LineSegments<BufferGeometry, LineBasicMaterial> {
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

/** A simple head: x forward, y left, z up. */
export function headBody(): Object3D {
  const material = new MeshLambertMaterial({ color: 0x8c9aa8, transparent: true, opacity: 0.85 });
  const skull = new Mesh(new BoxGeometry(0.09, 0.17, 0.13), material);
  skull.position.set(-0.01, 0, 0.05);
  const neck = new Mesh(new BoxGeometry(0.05, 0.05, 0.1), material);
  neck.position.set(-0.01, 0, -0.06);
  return new Group().add(skull, neck);
}

/** An eye: a ball with a pyramid as its field of view; z forward, x right, y down. */
export function eyeBody(): Object3D {
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
  const lines = corners.flatMap((corner, i) => {
    const side = [...corner, ...corners[(i + 1) % 4]!];
    return [0, 0, 0, ...corner, ...side];
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(lines), 3));
  const pyramid = new LineSegments(geometry, new LineBasicMaterial({ color: 0x6aa0d8 }));
  return new Group().add(ball, pyramid);
}

/** A name that always faces the viewer. */
export function labelOf(text: string): Object3D {
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
