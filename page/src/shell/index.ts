// SPDX-License-Identifier: Apache-2.0
export * from "./h";
export * from "./panel";
export * from "./shell";
