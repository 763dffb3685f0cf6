// SPDX-License-Identifier: Apache-2.0
export { ImageView } from "./image";
export * from "./panels";
export * from "./picture";
export * from "./probe";
export { StreamView } from "./stream_view";
export type * from "./view";
