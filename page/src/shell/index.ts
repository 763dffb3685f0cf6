// SPDX-License-Identifier: Apache-2.0
export * from "./h";
export { meanings } from "./help";
export * from "./layout";
export { standardPanels } from "./opener";
export * from "./panel";
export * from "./shell";
export { colour, onTheme } from "./theme";
