// SPDX-License-Identifier: Apache-2.0
// The parts of a graph that a person thinks in: a task, a person's devices, "ball ×2", the viewers.
// They follow from modes, links and included graphs alone. Pure.
import type { GraphLink, GraphModule, GraphState } from "../server";

/** Name of the module of `MODULE.PORT`. */
export function moduleOf(port: string): string {
  return port.slice(0, port.indexOf("."));
}

/** Name of the port of `MODULE.PORT`. */
export function portOf(port: string): string {
  return port.slice(port.indexOf(".") + 1);
}

/** Whether a link distributes the focus, the stop, or poses of frames. */
export function isBackground(link: GraphLink): boolean {
  return ["focus", "stop", "stopped", "frames"].includes(portOf(link.to));
}

export type PartKind = "module" | "task" | "workspace" | "person" | "viewers";

/** A module, or several that a person thinks of as one. */
export interface Part {
  /** That of its only module, or one with a colon. */
  readonly key: string;
  readonly label: string;
  readonly kind: PartKind;
  readonly members: readonly string[];
  /** The included graph without tasks, such as a head, to which it belongs; empty: none. */
  readonly body: string;
}

/** Shorter runs are not folded. */
const shortestRun = 4;

/** Which modules feed which, apart from the background. */
class Flow {
  private readonly after = new Map<string, Set<string>>();
  private readonly before = new Map<string, Set<string>>();

  constructor(links: readonly GraphLink[], modules: ReadonlySet<string>) {
    for (const link of links) {
      const [from, to] = [moduleOf(link.from), moduleOf(link.to)];
      if (from === to || isBackground(link) || !modules.has(from) || !modules.has(to)) continue;
      this.after.set(from, this.readers(from).add(to));
      this.before.set(to, this.writers(to).add(from));
    }
  }

  readers(name: string): Set<string> {
    return this.after.get(name) ?? new Set();
  }

  writers(name: string): Set<string> {
    return this.before.get(name) ?? new Set();
  }
}

/** The parts of a graph, in the order of their first modules; deterministic. */
export function partsOf(state: GraphState): Part[] {
  const modules = new Map(state.modules.map((module) => [module.name, module]));
  const names = [...modules.keys()];
  const isTask = (name: string): boolean => (modules.get(name)?.mode ?? "") !== "";
  const decides = (name: string): boolean => name in state.focus;
  const hasTasks = new Set(
    names.filter((name) => isTask(name) || decides(name)).map((name) => modules.get(name)!.group),
  );
  const bodyOf = (name: string): string => {
    const { group } = modules.get(name)!;
    return hasTasks.has(group) ? "" : group;
  };
  const short = (name: string): string => {
    const { group } = modules.get(name)!;
    return group && name.startsWith(`${group}_`) ? name.slice(group.length + 1) : name;
  };

  const parts = new Map<string, Part>();
  const taken = new Set<string>();
  const take = (part: Omit<Part, "body">): void => {
    parts.set(part.key, { ...part, body: bodyOf(part.members[0]!) });
    for (const member of part.members) taken.add(member);
  };
  const free = (): string[] => names.filter((name) => !taken.has(name));

  for (const name of names.filter(decides)) {
    take({ key: name, label: short(name), kind: "workspace", members: [name] });
  }
  for (const mode of new Set(free().map((name) => modules.get(name)!.mode))) {
    if (mode === "") continue;
    const members = free().filter((name) => modules.get(name)!.mode === mode);
    const key = members.length > 1 ? `task:${mode}` : members[0]!;
    take({ key, label: mode, kind: "task", members });
  }

  // What shows, scores or records: read by none, in a graph that has tasks. An actor is fed by tasks.
  const all = new Flow(state.links, new Set(names));
  const isActor = (name: string): boolean => {
    const writers = [...all.writers(name)];
    return writers.length > 0 && writers.every(isTask);
  };
  const isAside = (name: string, readers: ReadonlySet<string>): boolean =>
    hasTasks.size > 0 &&
    !taken.has(name) &&
    !bodyOf(name) &&
    !isActor(name) &&
    [...all.readers(name)].every((reader) => readers.has(reader));
  const ends = new Set(names.filter((name) => isAside(name, new Set())));
  const flow = new Flow(state.links, new Set(names.filter((name) => !ends.has(name))));

  const steering = state.links.filter(
    ({ to }) => decides(moduleOf(to)) && ["person", "stop"].includes(portOf(to)),
  );
  const steers = new Set(steering.map(({ from }) => moduleOf(from)));
  const devices = free().filter((name) => {
    if (bodyOf(name)) return false;
    const readers = [...flow.readers(name)];
    const isDevice = readers.length > 0 && flow.writers(name).size === 0;
    return (
      steers.has(name) || (isDevice && readers.every((each) => isTask(each) && steers.has(each)))
    );
  });
  if (devices.length > 0) {
    const key = devices.length > 1 ? "person:" : devices[0]!;
    take({ key, label: "person", kind: "person", members: devices });
  }

  // What serves only its own body: it belongs to the reader that has the fewest readers itself.
  const details = new Map<string, string[]>();
  for (const name of free()) {
    const readers = [...flow.readers(name)];
    const isInside = bodyOf(name) && readers.every((each) => bodyOf(each) === bodyOf(name));
    if (!isInside || readers.length === 0 || flow.writers(name).size > 0) continue;
    const host = readers.reduce((a, b) => (flow.readers(b).size < flow.readers(a).size ? b : a));
    details.set(host, [...(details.get(host) ?? []), name]);
  }
  for (const [host, others] of details) {
    if (taken.has(host)) continue;
    take({ key: `${host}:`, label: short(host), kind: "module", members: [host, ...others] });
  }

  for (const name of free()) {
    if (taken.has(name)) continue;
    const { program } = modules.get(name)!;
    const isSibling = (other: string): boolean =>
      modules.get(other)!.program === program &&
      bodyOf(other) === bodyOf(name) &&
      [...flow.readers(other)].some((reader) => flow.readers(name).has(reader));
    const members = free().filter((other) => other === name || isSibling(other));
    if (members.length < 2) continue;
    const label = `${commonName(members.map(short)) || programName(program)} ×${members.length}`;
    take({ key: `${name}:`, label, kind: "module", members });
  }

  const viewers = free().filter((name) => ends.has(name) || isAside(name, ends));
  if (viewers.length > 1) {
    take({ key: "viewers:", label: "viewers", kind: "viewers", members: viewers });
  }

  const singles = new Set(free());
  for (const run of runsOf([...singles], flow)) {
    const [first, last] = [short(run[0]!), short(run.at(-1)!)];
    take({ key: `${run[0]}:`, label: `${first} … ${last}`, kind: "module", members: run });
  }
  for (const name of free()) {
    take({ key: name, label: short(name), kind: "module", members: [name] });
  }
  return names.flatMap((name) => [...parts.values()].filter(({ members }) => members[0] === name));
}

/** Long rows of modules, each of which only reads the one before and is only read by the next. */
function runsOf(names: readonly string[], flow: Flow): string[][] {
  const only = (those: ReadonlySet<string>): string | undefined =>
    those.size === 1 ? [...those][0] : undefined;
  const inner = new Set(
    names.filter((name) => only(flow.readers(name)) && only(flow.writers(name))),
  );
  const runs: string[][] = [];
  for (const name of names) {
    if (!inner.has(name)) continue;
    const previous = only(flow.writers(name))!;
    if (inner.has(previous) && only(flow.readers(previous)) === name) continue; // not its first
    const run: string[] = [];
    for (let at = name; inner.has(at) && !run.includes(at); at = only(flow.readers(at))!) {
      run.push(at);
    }
    if (run.length >= shortestRun) runs.push(run);
  }
  return runs;
}

/** The words, parted by "_", that names have in common at their ends or beginnings. */
function commonName(names: readonly string[]): string {
  const common = (split: (words: string[], n: number) => string[]): string => {
    const words = names.map((name) => name.split("_"));
    const most = Math.min(...words.map(({ length }) => length));
    for (let n = most; n > 0; --n) {
      const texts = new Set(words.map((each) => split(each, n).join("_")));
      if (texts.size === 1) return [...texts][0]!;
    }
    return "";
  };
  return common((words, n) => words.slice(-n)) || common((words, n) => words.slice(0, n));
}

export function programName(program: GraphModule["program"]): string {
  return program.split("/").at(-1) ?? program;
}
