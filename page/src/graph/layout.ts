// SPDX-License-Identifier: Apache-2.0
// The layout of a graph's drawing, by dagre: data flows from left to right.
import { Graph, layout as dagreLayout } from "@dagrejs/dagre";
import type { Edge, Structure } from "./structure";

/** [px] of the drawing, from its top left corner. */
export interface Point {
  readonly x: number;
  readonly y: number;
}

export interface Box extends Point {
  /** x, y: its centre. */
  readonly width: number;
  readonly height: number;
}

export interface Layout {
  readonly width: number;
  readonly height: number;
  readonly nodes: ReadonlyMap<string, Box>;
  /** A group whose members are far apart has several boxes. */
  readonly groups: readonly { readonly group: string; readonly box: Box }[];
  /** Lines and their labels, by keys of edges. */
  readonly edges: ReadonlyMap<string, Line>;
}

export const nodeHeight = 52; // [px]
const labelSize = { width: 78, height: 26 };

/** Width of a module with this name [px]. */
function nodeWidth(name: string): number {
  return Math.max(112, 34 + name.length * 7.6);
}

/** The points of a line, and the position of its label. */
export interface Line {
  readonly points: readonly Point[];
  readonly label: Point;
}

/** Members of a group drawn in one box. */
interface Piece {
  readonly key: string;
  readonly group: string;
  readonly members: readonly string[];
}

/** Lays out a structure; deterministic. Cost: about 100 ms for 30 modules. */
export function layoutOf(structure: Structure): Layout {
  const pieces = piecesOf(structure, place(structure, []));
  const graph = place(structure, pieces);
  const box = (name: string): Box => {
    const { x, y, width, height } = graph.node(name) as Box;
    return { x, y, width, height };
  };
  const nodes = new Map(structure.nodes.map(({ name }) => [name, box(name)]));
  const between = new Map<string, Line>();
  for (const edge of structure.edges) {
    const found = graph.edge(edge.from, edge.to) as (Point & { points: Point[] }) | undefined;
    if (found) between.set(edge.key, { points: found.points.slice(1, -1), label: found });
  }
  const edges = attach(structure, nodes, between);
  const { width = 0, height = 0 } = graph.graph() as { width?: number; height?: number };
  const groups = pieces.map(({ key, group }) => ({ group, box: box(key) }));
  return { width, height, nodes, groups, edges };
}

/** The layout by dagre, with a box around each piece. */
function place(structure: Structure, pieces: readonly Piece[]): InstanceType<typeof Graph> {
  const graph = new Graph({ compound: true });
  const margins = { marginx: 12, marginy: 12 };
  graph.setGraph({ rankdir: "LR", nodesep: 18, edgesep: 12, ranksep: 40, ...margins });
  for (const { name } of structure.nodes) {
    graph.setNode(name, { width: nodeWidth(name), height: nodeHeight });
  }
  for (const { key, members } of pieces) {
    graph.setNode(key, {});
    for (const member of members) graph.setParent(member, key);
  }
  for (const edge of structure.edges) {
    if (!edge.background && edge.from !== edge.to) {
      graph.setEdge(edge.from, edge.to, { ...labelSize, labelpos: "c" });
    }
  }
  dagreLayout(graph);
  return graph;
}

/**
 * Groups, split where their members are far apart, like the eyes and the neck of a head: one box
 * around all of them would cover the whole drawing.
 */
function piecesOf(structure: Structure, graph: InstanceType<typeof Graph>): Piece[] {
  const columnOf = (name: string): number => Math.round((graph.node(name) as Box).x);
  const columns = [...new Set(structure.nodes.map(({ name }) => columnOf(name)))];
  const ranks = new Map(columns.sort((a, b) => a - b).map((x, rank) => [x, rank]));
  const rankOf = (name: string): number => ranks.get(columnOf(name)) ?? 0;
  const pieces: Piece[] = [];
  for (const group of new Set(structure.nodes.map((node) => node.group))) {
    if (group === "") continue;
    const members = structure.nodes
      .filter((node) => node.group === group)
      .map(({ name }) => name)
      .sort((a, b) => rankOf(a) - rankOf(b));
    let run: string[] = [];
    members.forEach((member, i) => {
      run.push(member);
      const next = members[i + 1];
      if (next !== undefined && rankOf(next) - rankOf(member) <= 1) return;
      pieces.push({ key: `group ${group} ${pieces.length}`, group, members: run });
      run = [];
    });
  }
  return pieces;
}

/**
 * Lines from the right sides of modules to the left sides of others, spread along the sides in the
 * order of their other ends, so that few cross.
 */
function attach(
  structure: Structure,
  nodes: ReadonlyMap<string, Box>,
  between: ReadonlyMap<string, Line>,
): Map<string, Line> {
  const route = (edge: Edge): readonly Point[] => between.get(edge.key)?.points ?? [];
  const spread = (edges: readonly Edge[], edge: Edge, box: Box, toward: (edge: Edge) => number) => {
    const order = edges.filter((each) => !each.background).sort((a, b) => toward(a) - toward(b));
    const place = edge.background ? 0.5 : (order.indexOf(edge) + 1) / (order.length + 1);
    return box.y + (place - 0.5) * (box.height - 8);
  };
  const lines = new Map<string, Line>();
  for (const edge of structure.edges) {
    const from = nodes.get(edge.from)!;
    const to = nodes.get(edge.to)!;
    const leaving = structure.edges.filter((each) => each.from === edge.from);
    const coming = structure.edges.filter((each) => each.to === edge.to);
    const start = {
      x: from.x + from.width / 2,
      y: spread(leaving, edge, from, (each) => (route(each)[0] ?? nodes.get(each.to)!).y),
    };
    const end = {
      x: to.x - to.width / 2,
      y: spread(coming, edge, to, (each) => (route(each).at(-1) ?? nodes.get(each.from)!).y),
    };
    const points = [start, ...route(edge), end];
    const middle = { x: (start.x + end.x) / 2, y: (start.y + end.y) / 2 };
    lines.set(edge.key, { points, label: between.get(edge.key)?.label ?? middle });
  }
  return lines;
}

/** A path through points, horizontal at each of them, as the `d` of an SVG path. */
export function pathThrough(points: readonly Point[]): string {
  const at = (x: number, y: number): string => `${x.toFixed(1)} ${y.toFixed(1)}`;
  let path = "";
  points.forEach((point, i) => {
    const before = points[i - 1];
    if (!before) {
      path = `M${at(point.x, point.y)}`;
      return;
    }
    // A backward line swings out on both sides.
    const reach = point.x > before.x ? (point.x - before.x) / 2 : 60;
    path += `C${at(before.x + reach, before.y)} ${at(point.x - reach, point.y)} ${at(point.x, point.y)}`;
  });
  return path;
}
