// SPDX-License-Identifier: Apache-2.0
// For tests: the state of a graph as its file describes it, as far as the drawing depends on it.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { parse, type TomlTable as Table } from "smol-toml";
import type { GraphLink, GraphModule, GraphState } from "../server";

const expand = (text: string): string => text.replace(/\$\{\w+:-([^}]*)\}/g, "$1");

interface Read {
  readonly modules: GraphModule[];
  readonly links: GraphLink[];
  readonly modes: Record<string, number>;
  readonly workspaces: string[];
}

function read(folder: string, file: string): Read {
  const toml = parse(readFileSync(join(folder, file), "utf8"));
  const all: Read = { modules: [], links: [], modes: {}, workspaces: [] };
  for (const [name, included] of Object.entries((toml.graphs ?? {}) as Table)) {
    const { file: other, ...others } = included as Table;
    const inside = read(folder, expand(other as string));
    const tables = (others.modules ?? {}) as Record<string, Table>;
    const isOurs = (end: string): boolean =>
      inside.modules.some((module) => module.name === end.split(".")[0]);
    const prefix = (end: string): string => (isOurs(end) ? `${name}_${end}` : end);
    all.links.push(
      ...inside.links.map((link) => ({ ...link, from: prefix(link.from), to: prefix(link.to) })),
    );
    for (const [module, table] of Object.entries(tables)) {
      for (const key of ["inputs", "more_inputs"] as const) {
        all.links.push(...linksInto(`${name}_${module}`, (table[key] ?? {}) as Table));
      }
    }
    all.modules.push(
      ...inside.modules.map((each) => ({ ...each, name: prefix(each.name), group: name })),
    );
    Object.assign(all.modes, inside.modes);
    all.workspaces.push(...inside.workspaces.map(prefix));
  }
  Object.assign(all.modes, toml.modes ?? {});
  const workspace = (toml.workspace as Table | undefined)?.module;
  if (workspace) all.workspaces.push(workspace as string);
  for (const [name, table] of Object.entries((toml.modules ?? {}) as Record<string, Table>)) {
    all.modules.push(
      moduleNamed(name, {
        program: (table.program as string | undefined) ?? name,
        mode: (table.mode as string | undefined) ?? "",
        workspace: table.mode ? (all.workspaces[0] ?? "") : "",
      }),
    );
    all.links.push(...linksInto(name, (table.inputs ?? {}) as Table));
  }
  return all;
}

function linksInto(name: string, inputs: Table): GraphLink[] {
  /** The outputs in a value: "a.b", { from = …, rate = 20 }, or an array of these. */
  const sources = (value: unknown): string[] => {
    if (typeof value === "string") return [value];
    return Array.isArray(value) ? value.flatMap(sources) : sources((value as Table).from);
  };
  return Object.entries(inputs).flatMap(([input, value]) =>
    sources(value).map((from) => linkOf(expand(from), `${name}.${input}`)),
  );
}

/** The state of a graph of graphs/ before anything has happened. */
export function stateOfFile(file: string): GraphState {
  const folder = process.env.HC_GRAPHS;
  if (!folder) throw new Error("HC_GRAPHS is not set");
  const { modules, links, modes, workspaces } = read(folder, file);
  const focus = Object.fromEntries(workspaces.map((name) => [name, null]));
  return { ...stateOf(modules, links), focus, modes };
}

export function moduleNamed(name: string, other: Partial<GraphModule> = {}): GraphModule {
  return {
    name,
    program: name,
    group: "",
    pid: 1,
    status: "running",
    detail: "",
    last_line: "",
    last_level: "info",
    restarts: 0,
    exit: null,
    cpu: 0,
    memory: 0,
    mode: "",
    modes: [],
    workspace: "",
    in_focus: true,
    in_workspace: false,
    parameters: {},
    ...other,
  };
}

export function linkOf(from: string, to: string, other: Partial<GraphLink> = {}): GraphLink {
  return {
    from,
    to,
    status: "",
    keep: "all",
    rate: 0,
    bandwidth: 0,
    images: null,
    messages: 0,
    bytes: 0,
    per_second: 0,
    bytes_per_second: 0,
    delayed: 0,
    throttled: 0,
    dropped_newer: 0,
    dropped_memory: 0,
    dropped_disconnect: 0,
    dropped_timeout: 0,
    ignored: 0,
    in_workspace: false,
    age: null,
    ...other,
  };
}

export function stateOf(modules: GraphModule[], links: GraphLink[], uptime = 0): GraphState {
  return {
    graph: "g",
    file: "g.toml",
    pid: 1,
    uptime,
    status: "running",
    focus: {},
    stopped_by: {},
    modules,
    links,
    modes: {},
  };
}
