// SPDX-License-Identifier: Apache-2.0
import { graphPanel, modulePanel } from "./graph";
import { addStop, seatPanel } from "./seat";
import { Server } from "./server";
import { panelKinds, Shell } from "./shell";

Object.assign(panelKinds, { graph: graphPanel, module: modulePanel, seat: seatPanel });

const shell = new Shell(new Server());
addStop(shell);
document.body.append(shell.element);
