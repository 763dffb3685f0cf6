// SPDX-License-Identifier: Apache-2.0
import { consoleView } from "./console";
import { imageView } from "./image";
import { plotView } from "./plot";
import { tableView } from "./table";
import { depthView, valuesView } from "./values";
import type { ViewKind } from "./view";

/** Ways to show a stream; the first one that fits is the usual one. */
export const viewKinds: readonly ViewKind[] = [
  depthView,
  imageView,
  consoleView,
  plotView,
  valuesView,
  tableView,
];
