// SPDX-License-Identifier: Apache-2.0
// The structure of a graph's drawing: modules in groups, and one edge for all links of two modules.
import type { GraphLink, GraphModule, GraphState } from "../server";

/** All links from one module to another. */
export interface Edge {
  /** `FROM>TO`, names of modules. */
  readonly key: string;
  readonly from: string;
  readonly to: string;
  /** Names as in links: `MODULE.PORT MODULE.PORT`. */
  readonly links: readonly string[];
  /** Its links only carry the focus or the poses of frames. */
  readonly background: boolean;
}

export interface Structure {
  readonly nodes: readonly { readonly name: string; readonly group: string }[];
  readonly edges: readonly Edge[];
  /** Equal for states that have the same structure. */
  readonly key: string;
}

/** Name of the module of `MODULE.PORT`. */
export function moduleOf(port: string): string {
  return port.slice(0, port.indexOf("."));
}

/** Name of the port of `MODULE.PORT`. */
export function portOf(port: string): string {
  return port.slice(port.indexOf(".") + 1);
}

export function linkKey(link: GraphLink): string {
  return `${link.from} ${link.to}`;
}

/** Whether a link distributes the focus, the stop, or poses of frames. */
function isBackground(link: GraphLink): boolean {
  return ["focus", "stopped", "frames"].includes(portOf(link.to));
}

export function structureOf(state: GraphState): Structure {
  const nodes = state.modules.map(({ name, group }) => ({ name, group }));
  const known = new Set(nodes.map((node) => node.name));
  const edges = new Map<
    string,
    { from: string; to: string; links: string[]; background: boolean }
  >();
  for (const link of state.links) {
    const from = moduleOf(link.from);
    const to = moduleOf(link.to);
    if (!known.has(from) || !known.has(to)) continue; // a URI outside of the graph
    const edge = edges.get(`${from}>${to}`) ?? { from, to, links: [], background: true };
    edge.links.push(linkKey(link));
    edge.background &&= isBackground(link);
    edges.set(`${from}>${to}`, edge);
  }
  const list = [...edges].map(([key, edge]) => ({ key, ...edge }));
  const key = JSON.stringify([nodes, list.map((edge) => [edge.key, edge.background])]);
  return { nodes, edges: list, key };
}

/** Links to and from a module. */
export function linksOf(state: GraphState, module: GraphModule): GraphLink[] {
  return state.links.filter(
    (link) => moduleOf(link.from) === module.name || moduleOf(link.to) === module.name,
  );
}
