// SPDX-License-Identifier: Apache-2.0
// The structure of a graph's drawing: its parts, or the modules of those that are open, and one edge
// for all links between two of them.
import { moduleOf, type GraphLink, type GraphModule, type GraphState } from "../server";
import { framesOf } from "../views/frames";
import { isBackground, partsOf, type PartKind } from "./parts";

/** A box of the drawing. */
export interface Node {
  /** That of its part; of an open part's module and of a place outside, the name. */
  readonly key: string;
  readonly label: string;
  readonly kind: PartKind | "outside";
  readonly members: readonly string[];
  /** The included graph or the open part to which it belongs; empty: none. */
  readonly caption: string;
  /** Key of that open part; empty: none. */
  readonly part: string;
  /** Its output that moves a frame; empty: none. */
  readonly pose: string;
}

/** All links from one node to another. */
export interface Edge {
  /** `FROM>TO`, keys of nodes. */
  readonly key: string;
  readonly from: string;
  readonly to: string;
  /** Names as in links: `MODULE.PORT MODULE.PORT`. */
  readonly links: readonly string[];
  /** Its links only carry the focus, the stop or the poses of frames. */
  readonly background: boolean;
}

export interface Structure {
  readonly nodes: readonly Node[];
  readonly edges: readonly Edge[];
}

/** Equal for states that have the same structure. @param frames  the text of G31. */
export function structureKey(state: GraphState, open: ReadonlySet<string>, frames = ""): string {
  const modules = state.modules.map(({ name, program, group, mode }) => [
    name,
    program,
    group,
    mode,
  ]);
  const links = state.links.map(linkKey);
  return JSON.stringify([modules, links, Object.keys(state.focus), [...open], frames]);
}

export function linkKey(link: GraphLink): string {
  return `${link.from} ${link.to}`;
}

/** A place outside of the graph without its options, such as `dds:robot/camera`. */
function placeOf(uri: string): string {
  return uri.replace(/[?#].*/, "");
}

/** @param open  keys of the parts that are open. @param frames  the text of G31. */
export function structureOf(state: GraphState, open: ReadonlySet<string>, frames = ""): Structure {
  const moved = framesOf(frames).flatMap(({ movedBy }) => movedBy ?? []);
  // An output that moves several frames has no single pose.
  const poses = moved.filter((port) => moved.indexOf(port) === moved.lastIndexOf(port));
  const nodes: Node[] = [];
  const nodeOf = new Map<string, string>(); // of a module
  const add = (node: Omit<Node, "pose">): void => {
    const pose = poses.find((port) => node.members.includes(moduleOf(port))) ?? "";
    nodes.push({ ...node, pose });
    for (const member of node.members) nodeOf.set(member, node.key);
  };
  for (const part of partsOf(state)) {
    const { key, label, members, body } = part;
    if (members.length > 1 && open.has(key)) {
      const inside = { kind: part.kind, caption: label, part: key };
      for (const name of members) add({ ...inside, key: name, label: name, members: [name] });
    } else {
      add({ key, label, kind: part.kind, members, caption: body, part: "" });
    }
  }
  const edges = new Map<string, Edge & { links: string[]; background: boolean }>();
  const endOf = (end: string): string => {
    const known = nodeOf.get(moduleOf(end));
    if (known !== undefined) return known;
    const key = placeOf(end);
    if (!nodes.some((node) => node.key === key)) {
      add({ key, label: key, kind: "outside", members: [], caption: "", part: "" });
    }
    return key;
  };
  for (const link of state.links) {
    const [from, to] = [endOf(link.from), endOf(link.to)];
    if (from === to) continue;
    const key = `${from}>${to}`;
    const edge = edges.get(key) ?? { key, from, to, links: [], background: true };
    edge.links.push(linkKey(link));
    edge.background &&= isBackground(link);
    edges.set(key, edge);
  }
  return { nodes, edges: [...edges.values()] };
}

/** Links to and from a module. */
export function linksOf(state: GraphState, module: GraphModule): GraphLink[] {
  return state.links.filter(
    (link) => moduleOf(link.from) === module.name || moduleOf(link.to) === module.name,
  );
}
