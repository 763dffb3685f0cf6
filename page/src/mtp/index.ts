// SPDX-License-Identifier: Apache-2.0
// MTP/1 (spec/mtp-1.md) in TypeScript.
export * from "./coord";
export * from "./error";
export * from "./info";
export * from "./message";
export * from "./reader";
export * from "./writer";
