// SPDX-License-Identifier: Apache-2.0
export { recordingsPanel } from "./recordings_panel";
export { replayPanel } from "./replay_panel";
