// SPDX-License-Identifier: Apache-2.0
import { h, type PanelKind } from "../shell";

/** The live graph: {kind: "graph"}. */
export const graphPanel: PanelKind = (_args, host) => {
  host.setTitle("Graph");
  return { element: h("div", { class: "graph" }) };
};

/** A module's ports, parameters and log: {kind: "module", name}. */
export const modulePanel: PanelKind = (args, host) => {
  host.setTitle(args.name ?? "module");
  return { element: h("div", { class: "module" }) };
};
