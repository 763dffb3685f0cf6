// SPDX-License-Identifier: Apache-2.0
export { graphPanel } from "./panel";
export { modulePanel } from "./module";
