// SPDX-License-Identifier: Apache-2.0
export { ImageView } from "./image";
export * from "./panels";
export * from "./picture";
export * from "./probe";
export { scenePanel } from "./scene_panel";
export { StreamView } from "./stream_view";
export type * from "./view";
