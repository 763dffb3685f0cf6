// SPDX-License-Identifier: Apache-2.0
// MTP/1 (spec/mtp-1.md) in TypeScript.
export * from "./coord";
export { elementsOf } from "./elements";
export * from "./error";
export * from "./header";
export * from "./info";
export * from "./message";
export * from "./number";
export * from "./reader";
export * from "./writer";
