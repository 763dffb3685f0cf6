// SPDX-License-Identifier: Apache-2.0
import type { Header } from "../mtp";
import { barsView } from "./bars";
import { bothEyesView } from "./both_eyes";
import { consoleView } from "./console";
import { imageView } from "./image";
import { networkView } from "./network";
import { plotView } from "./plot";
import { cloudView, sceneView } from "./scene_kind";
import { poseView } from "./pose_view";
import { soundView } from "./sound";
import { matrixView, tableView } from "./table";
import { depthView, valuesView } from "./values";
import type { About, ViewKind } from "./view";

/** Ways to show streams; a name may occur twice, first for streams with it as default. */
const viewKinds: readonly ViewKind[] = [
  depthView,
  bothEyesView,
  imageView,
  consoleView,
  soundView,
  networkView,
  cloudView,
  poseView,
  barsView,
  matrixView,
  plotView,
  sceneView,
  valuesView,
  tableView,
];

/** The ways to show a stream, the default first. */
export function kindsFor(sent: Header, about: About): ViewKind[] {
  const fitting = viewKinds.filter((kind) => kind.fits(sent, about));
  return fitting.filter(
    ({ name }, index) => fitting.findIndex((each) => each.name === name) === index,
  );
}
