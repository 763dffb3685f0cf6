// SPDX-License-Identifier: Apache-2.0
import type { Header } from "../mtp";
import type { ViewKind } from "./view";

/** Whether elements are metres or radians in a spatial frame, not pixels or a gaze. */
function isInSpace({ coord }: Header): boolean {
  return coord <= 6 || coord === 14 || (coord >= 100 && coord < 1000);
}

/** Streams that the scene shows. */
export const sceneView: ViewKind = {
  name: "scene",
  fits: (sent) => {
    if (sent.type === "transformation") return sent.width === 4 && sent.height === 4;
    if (sent.type === "position" || sent.type === "rotation") return isInSpace(sent);
    const isFloat = sent.scalar === "f32" || sent.scalar === "f64";
    return sent.type === "vector_field" && sent.components >= 3 && isFloat && isInSpace(sent);
  },
  make: async (host) => {
    await host.surroundings.ready();
    return new (await import("./scene")).SceneView(host);
  },
};

/** The default view of a point cloud. */
export const cloudView: ViewKind = {
  ...sceneView,
  fits: (sent, about) => sent.type === "vector_field" && sceneView.fits(sent, about),
};
