// SPDX-License-Identifier: Apache-2.0
export * from "./drive";
export * from "./server";
export * from "./signal";
export { bidsOf, type Bid } from "./standings";
export * from "./stream";
export * from "./types";
