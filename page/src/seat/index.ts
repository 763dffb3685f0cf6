// SPDX-License-Identifier: Apache-2.0
export { seatPanel } from "./panel";
export { addStop } from "./stop";
