// SPDX-License-Identifier: Apache-2.0
// The layout of a graph's drawing in columns. It depends on the structure alone. Pure.
import { columnsOf } from "./columns";
import { areaOf, placeLabels, type Area, type Label, type Point } from "./labels";
import type { Edge, Node, Structure } from "./structure";

export interface Box extends Point {
  /** x, y: its centre. */
  readonly width: number;
  readonly height: number;
}

/** The points of a line, and its label, if there is room for one. */
export interface Line {
  readonly points: readonly Point[];
  readonly label?: Label;
}

export interface Layout {
  readonly width: number;
  readonly height: number;
  readonly nodes: ReadonlyMap<string, Box>;
  /** By keys of edges. */
  readonly edges: ReadonlyMap<string, Line>;
}

const margin = 14; // [px]
/** Between columns, for labels and bends [px]. */
const columnGap = 84;
const rowGap = 14; // [px]
const nodeSize = { width: 120, most: 184, height: 48 }; // [px]
/** The least of a node that shows a pose below its other texts [px]. */
const poseSize = { width: 134, height: 64 };
/** Of a letter of a node's name [px]. */
const letterWidth = 7.8;
/** Between lines at the side of a node, so that their labels have room [px]. */
const lineGap = 13;
/** Above a node for the name of its part or body [px]. */
const captionHeight = 16;
/** Of the box behind that of a part, to the right and down [px]. */
export const stackOffset = 4;
const passHeight = 4; // of a line that passes a column [px]
const sweeps = 24;

type Side = "left" | "right";

/** A node, or a place where a line passes a column. */
interface Cell {
  readonly key: string;
  readonly column: number;
  readonly height: number;
  /** Keys of the cells to which lines lead. */
  readonly neighbours: string[];
  y: number; // of its centre
}

/** Lays out a structure; deterministic. */
export function layoutOf(structure: Structure): Layout {
  const columns = columnsOf(structure);
  const flow = structure.edges.filter(({ background }) => !background);
  const sides = (edge: Edge): [Side, Side] => {
    const [from, to] = [columns.get(edge.from)!, columns.get(edge.to)!];
    return from === to ? ["right", "right"] : from < to ? ["right", "left"] : ["left", "right"];
  };
  const endsAt = (key: string, side: Side): number =>
    flow.filter((edge) => edge.from === key && sides(edge)[0] === side).length +
    flow.filter((edge) => edge.to === key && sides(edge)[1] === side).length;
  const withPose = new Set(structure.nodes.flatMap(({ key, pose }) => (pose ? [key] : [])));
  const heightOf = (key: string): number =>
    Math.max(
      (withPose.has(key) ? poseSize : nodeSize).height,
      lineGap * (1 + Math.max(endsAt(key, "left"), endsAt(key, "right"))),
    );

  const cells = cellsOf(structure, columns, heightOf);
  arrange(cells);

  const tops = [...cells.values()].map((cell) => cell.y - cell.height / 2);
  const top = margin - Math.min(...tops);
  const widths = widthsOf(structure.nodes, columns);
  const leftOf = (column: number): number =>
    margin + widths.slice(0, column).reduce((sum, width) => sum + width + columnGap, 0);
  const nodes = new Map(
    structure.nodes.map((node) => {
      const cell = cells.get(node.key)!;
      const height = heightOf(node.key);
      const caption = node.caption ? captionHeight : 0;
      const column = columns.get(node.key)!;
      const box = { x: leftOf(column) + widths[column]! / 2, y: cell.y + top + caption / 2 };
      return [node.key, { ...box, width: widths[column]!, height }];
    }),
  );

  /** Where a line passes the columns between its ends. */
  const passes = (edge: Edge): Point[] => {
    const [from, to] = [columns.get(edge.from)!, columns.get(edge.to)!];
    const step = Math.sign(to - from);
    const points: Point[] = [];
    for (let column = from + step; step !== 0 && column !== to; column += step) {
      const cell = cells.get(passKey(edge, column));
      if (!cell) continue; // of the background
      const [left, right] = [leftOf(column), leftOf(column) + widths[column]!];
      const y = cell.y + top;
      points.push({ x: step > 0 ? left : right, y }, { x: step > 0 ? right : left, y });
    }
    return points;
  };
  const pointAt = (key: string, side: Side, edge: Edge): Point => {
    const { x, y, width, height } = nodes.get(key)!;
    const toward = (each: Edge): number => {
      const route = passes(each);
      const next = each.from === key ? route[0] : route.at(-1);
      return (next ?? nodes.get(each.from === key ? each.to : each.from)!).y;
    };
    const order = flow
      .filter(
        (each) =>
          (each.from === key && sides(each)[0] === side) ||
          (each.to === key && sides(each)[1] === side),
      )
      .sort((a, b) => toward(a) - toward(b));
    const place = order.indexOf(edge);
    const share = place < 0 ? 0.5 : (place + 1) / (order.length + 1);
    return { x: x + (side === "left" ? -width : width) / 2, y: y + (share - 0.5) * height };
  };
  const routes = new Map(
    structure.edges.map((edge) => {
      const [start, end] = sides(edge);
      const points = [pointAt(edge.from, start, edge), ...passes(edge)];
      return [edge.key, [...points, pointAt(edge.to, end, edge)]];
    }),
  );
  const filled = structure.nodes.flatMap((node) => areasOf(node, nodes.get(node.key)!));
  const shown = placeLabels(new Map(flow.map(({ key }) => [key, routes.get(key)!])), filled);
  // Those of the background yield, as if they were not there.
  const background = new Map(
    structure.edges.flatMap(({ key, background }) =>
      background ? [[key, routes.get(key)!] as const] : [],
    ),
  );
  const labels = new Map([
    ...placeLabels(background, [...filled, ...[...shown.values()].map(areaOf)]),
    ...shown,
  ]);
  const edges = new Map(
    [...routes].map(([key, points]) => [key, { points, label: labels.get(key) }]),
  );
  const bottoms = [...cells.values()].map((cell) => cell.y + top + cell.height / 2);
  const width = leftOf(widths.length) - columnGap + margin;
  return { width, height: Math.max(...bottoms) + margin, nodes, edges };
}

/** The areas of a node: its box, the box behind that of a part, and its caption. */
export function areasOf({ members, caption }: Node, { x, y, width, height }: Box): Area[] {
  const behind = members.length > 1 ? stackOffset : 0;
  const [left, top] = [x - width / 2, y - height / 2];
  const box = { left, top, right: left + width + behind, bottom: top + height + behind };
  return [box, ...(caption ? [{ ...box, top: top - captionHeight, bottom: top }] : [])];
}

function widthsOf(nodes: readonly Node[], columns: ReadonlyMap<string, number>): number[] {
  const count = 1 + Math.max(0, ...columns.values());
  return Array.from({ length: count }, (_, column) => {
    const names = nodes.filter(({ key }) => columns.get(key) === column);
    const longest = Math.max(
      ...names.map(({ label, pose }) =>
        Math.max(26 + label.length * letterWidth, pose ? poseSize.width : 0),
      ),
    );
    return Math.min(nodeSize.most, Math.max(nodeSize.width, longest));
  });
}

const passKey = (edge: Edge, column: number): string => `${edge.key} ${column}`;

function cellsOf(
  structure: Structure,
  columns: ReadonlyMap<string, number>,
  heightOf: (key: string) => number,
): Map<string, Cell> {
  const cells = new Map<string, Cell>();
  const add = (key: string, column: number, height: number): void => {
    cells.set(key, { key, column, height, neighbours: [], y: 0 });
  };
  for (const { key, caption } of structure.nodes) {
    add(key, columns.get(key)!, heightOf(key) + (caption ? captionHeight : 0));
  }
  for (const edge of structure.edges) {
    if (edge.background) continue;
    const [from, to] = [columns.get(edge.from)!, columns.get(edge.to)!];
    const step = Math.sign(to - from);
    let before = edge.from;
    const connect = (key: string): void => {
      cells.get(before)!.neighbours.push(key);
      cells.get(key)!.neighbours.push(before);
      before = key;
    };
    for (let column = from + step; step !== 0 && column !== to; column += step) {
      add(passKey(edge, column), column, passHeight);
      connect(passKey(edge, column));
    }
    connect(edge.to);
  }
  return cells;
}

/** Orders the cells of each column and places them, near their neighbours, with few crossings. */
function arrange(cells: ReadonlyMap<string, Cell>): void {
  const columns: Cell[][] = [];
  for (const cell of cells.values()) (columns[cell.column] ??= []).push(cell);
  const wanted = ({ neighbours, column, y }: Cell, side: number): number => {
    const those = neighbours
      .map((key) => cells.get(key)!)
      .filter((each) => Math.sign(each.column - column) === side || side === 0);
    return those.length === 0 ? y : those.reduce((sum, each) => sum + each.y, 0) / those.length;
  };
  for (const column of columns)
    settle(
      column,
      column.map(() => 0),
    );
  let best = { crossings: Infinity, orders: columns.map((column) => [...column]) };
  for (let sweep = 0; sweep < sweeps; ++sweep) {
    const isForward = sweep % 2 === 0;
    for (const column of isForward ? columns : [...columns].reverse()) {
      const at = new Map(column.map((cell) => [cell, wanted(cell, isForward ? -1 : 1)]));
      column.sort((a, b) => at.get(a)! - at.get(b)!);
      settle(
        column,
        column.map((cell) => at.get(cell)!),
      );
    }
    const crossings = crossingsOf(cells);
    if (crossings < best.crossings) {
      best = { crossings, orders: columns.map((column) => [...column]) };
    }
  }
  for (const column of best.orders)
    settle(
      column,
      column.map(() => 0),
    );
  for (let sweep = 0; sweep < sweeps; ++sweep) {
    const side = sweep >= sweeps - 4 ? 0 : sweep % 2 === 0 ? -1 : 1;
    for (const column of side > 0 ? [...best.orders].reverse() : best.orders) {
      settle(
        column,
        column.map((cell) => wanted(cell, side)),
      );
    }
  }
}

/** How many lines between neighbouring columns cross. */
function crossingsOf(cells: ReadonlyMap<string, Cell>): number {
  const lines = [...cells.values()].flatMap((from) =>
    from.neighbours
      .map((key) => cells.get(key)!)
      .filter((to) => to.column === from.column + 1)
      .map((to) => ({ column: from.column, from: from.y, to: to.y })),
  );
  let count = 0;
  lines.forEach((a, i) => {
    for (const b of lines.slice(i + 1)) {
      if (a.column === b.column && (a.from - b.from) * (a.to - b.to) < 0) ++count;
    }
  });
  return count;
}

/**
 * Places the cells of a column in their order as near as possible to what they want, without overlap:
 * a regression that keeps the order. Source: pool adjacent violators, Ayer et al., 1955.
 */
function settle(column: readonly Cell[], wanted: readonly number[]): void {
  let depth = 0;
  const offsets = column.map((cell, i) => {
    const before = column[i - 1];
    if (before) depth += (before.height + cell.height) / 2 + rowGap;
    return depth;
  });
  const pools: { sum: number; count: number }[] = [];
  wanted.forEach((y, i) => {
    let pool = { sum: y - offsets[i]!, count: 1 };
    for (;;) {
      const before = pools.at(-1);
      if (!before || before.sum / before.count <= pool.sum / pool.count) break;
      pools.pop();
      pool = { sum: before.sum + pool.sum, count: before.count + pool.count };
    }
    pools.push(pool);
  });
  const means = pools.flatMap(({ sum, count }) => Array<number>(count).fill(sum / count));
  column.forEach((cell, i) => (cell.y = means[i]! + offsets[i]!));
}
