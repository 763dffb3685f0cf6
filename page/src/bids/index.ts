// SPDX-License-Identifier: Apache-2.0
export { bidsPanel } from "./panel";
export { addWhy } from "./why";
