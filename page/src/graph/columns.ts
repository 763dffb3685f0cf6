// SPDX-License-Identifier: Apache-2.0
// The column of each node of a drawing: data flows from left to right. Pure, deterministic.
import type { Edge, Structure } from "./structure";

/**
 * Columns from 0 by node. Tasks share one, with their actors to the right. Edges back, as from a
 * neck to the eyes that it moves, and the background have no effect.
 */
export function columnsOf({ nodes, edges }: Structure): Map<string, number> {
  const kindOf = new Map(nodes.map(({ key, kind }) => [key, kind]));
  const isTask = (key: string): boolean => kindOf.get(key) === "task";
  const flow = edges.filter(({ background }) => !background);
  const writers = (key: string): string[] =>
    flow.filter(({ to }) => to === key).map(({ from }) => from);
  const partOf = new Map(nodes.map(({ key, part }) => [key, part || key]));
  /** Fed by tasks, and perhaps by persons and its own part, but by nothing else. */
  const isFedByTasks = (key: string): boolean =>
    !isTask(key) &&
    writers(key).some(isTask) &&
    writers(key).every(
      (each) =>
        isTask(each) || kindOf.get(each) === "person" || partOf.get(each) === partOf.get(key),
    );
  const commanded = new Set(
    nodes.filter(({ key }) => isFedByTasks(key)).map(({ key }) => partOf.get(key)!),
  );
  const isCommanded = (key: string): boolean => commanded.has(partOf.get(key)!);
  const leading = reachTo(
    nodes.filter(({ kind }) => kind === "task").map(({ key }) => key),
    flow,
  );
  const forward = withoutCycles(
    nodes.map(({ key }) => key),
    flow.filter(({ from, to }) => {
      if (isTask(from)) return isCommanded(to);
      return !(isCommanded(from) && leading.has(to));
    }),
  );
  const columns = new Map(nodes.map(({ key }) => [key, 0]));
  const settle = (): void => {
    let changed = true;
    while (changed) {
      changed = false;
      for (const { from, to } of forward) {
        if (columns.get(to)! > columns.get(from)!) continue;
        columns.set(to, columns.get(from)! + 1);
        changed = true;
      }
    }
  };
  settle();
  const tasks = nodes.filter(({ kind }) => kind === "task");
  const last = Math.max(0, ...tasks.map(({ key }) => columns.get(key)!));
  for (const { key } of tasks) columns.set(key, last);
  settle();
  // A source is next to its first reader.
  for (const { key } of nodes) {
    if (forward.some(({ to }) => to === key)) continue;
    const readers = forward.filter(({ from }) => from === key).map(({ to }) => columns.get(to)!);
    if (readers.length > 0 && !isTask(key)) columns.set(key, Math.min(...readers) - 1);
  }
  return columns;
}

/** The nodes from which edges lead to some of `goals`, and these. */
function reachTo(goals: readonly string[], edges: readonly Edge[]): Set<string> {
  const found = new Set(goals);
  for (const goal of found) {
    for (const { from, to } of edges) if (to === goal) found.add(from);
  }
  return found;
}

/** The edges without those that close a cycle, in the order of the nodes. */
function withoutCycles(keys: readonly string[], edges: readonly Edge[]): Edge[] {
  const leaving = new Map(keys.map((key) => [key, edges.filter(({ from }) => from === key)]));
  const kept: Edge[] = [];
  const state = new Map<string, "open" | "done">();
  const visit = (key: string): void => {
    state.set(key, "open");
    for (const edge of leaving.get(key)!) {
      if (state.get(edge.to) === "open") continue;
      kept.push(edge);
      if (!state.has(edge.to)) visit(edge.to);
    }
    state.set(key, "done");
  };
  for (const key of keys) if (!state.has(key)) visit(key);
  return kept;
}
