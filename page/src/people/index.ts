// SPDX-License-Identifier: Apache-2.0
// The people and hands that the robot sees, over its images.
export * from "./layer";
export * from "./people";
export * from "./tables";
