// SPDX-License-Identifier: Apache-2.0
import { addWhy, bidsPanel } from "./bids";
import { graphPanel, modulePanel } from "./graph";
import { logPanel } from "./log";
import { recordingsPanel, replayPanel } from "./recordings";
import { addStop, seatPanel } from "./seat";
import { Server } from "./server";
import { panelKinds, Shell, standardPanels } from "./shell";
import { scenePanel, streamPanel } from "./views";

Object.assign(panelKinds, {
  graph: graphPanel,
  log: logPanel,
  module: modulePanel,
  bids: bidsPanel,
  seat: seatPanel,
  recordings: recordingsPanel,
  replay: replayPanel,
  scene: scenePanel,
  stream: streamPanel,
});
standardPanels.push(
  { label: "Recordings", detail: "record, download, replay", args: { kind: "recordings" } },
  { label: "Scene", detail: "frames, head and points in space", args: { kind: "scene" } },
  { label: "Graph", detail: "modules and links, live", args: { kind: "graph" } },
  {
    label: "Bids for the focus",
    detail: "each task's bid, now and before",
    args: { kind: "bids" },
  },
  { label: "Log", detail: "what the modules report", args: { kind: "log" } },
  { label: "Seat", detail: "steer, speak, choose a task", args: { kind: "seat" } },
);

const shell = new Shell(new Server());
addWhy(shell);
addStop(shell);
document.body.append(shell.element);
