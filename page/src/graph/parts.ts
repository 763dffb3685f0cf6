// SPDX-License-Identifier: Apache-2.0
// The parts of a graph that a person thinks in: a task, a person's devices, "ball ×2", the viewers.
// They follow from modes, links and included graphs alone. Pure.
import {
  moduleOf,
  portOf,
  programName,
  type GraphLink,
  type GraphModule,
  type GraphState,
} from "../server";

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

  constructor(
    private readonly links: readonly GraphLink[],
    private readonly modules: ReadonlySet<string>,
  ) {
    for (const link of links) {
      const [from, to] = [moduleOf(link.from), moduleOf(link.to)];
      if (from === to || isBackground(link) || !modules.has(from) || !modules.has(to)) continue;
      this.after.set(from, this.readers(from).add(to));
      this.before.set(to, this.writers(to).add(from));
    }
  }

  /** The flow among the other modules. */
  without(those: ReadonlySet<string>): Flow {
    return new Flow(this.links, new Set([...this.modules].filter((name) => !those.has(name))));
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
  return new Grouping(state).parts();
}

/** Groups the modules of a graph, rule by rule; a module belongs to the first part that fits. */
class Grouping {
  private readonly modules: ReadonlyMap<string, GraphModule>;
  private readonly names: readonly string[];
  /** Included graphs that have tasks or a workspace; the empty name is the file itself. */
  private readonly withTasks: ReadonlySet<string>;
  private readonly flow: Flow;
  private readonly grouped = new Map<string, Part>(); // by member

  constructor(private readonly state: GraphState) {
    this.modules = new Map(state.modules.map((module) => [module.name, module]));
    this.names = [...this.modules.keys()];
    const deciding = this.names.filter((name) => this.isTask(name) || this.decides(name));
    this.withTasks = new Set(deciding.map((name) => this.groupOf(name)));
    this.flow = new Flow(state.links, new Set(this.names));
  }

  parts(): Part[] {
    for (const name of this.names.filter((each) => this.decides(each))) {
      this.take("workspace", this.short(name), [name]);
    }
    this.takeTasks();
    const ends = new Set(this.free().filter((name) => this.isViewer(name, new Set())));
    const viewers = this.free().filter((name) => this.isViewer(name, ends));
    const flow = this.flow.without(ends);
    this.takePerson(flow);
    this.takeDetails(flow);
    this.takeSiblings(flow);
    const left = viewers.filter((name) => !this.grouped.has(name));
    if (left.length > 1) this.take("viewers", "viewers", left, "viewers:");
    for (const run of runsOf(this.free(), flow)) {
      const [first, last] = [run[0]!, run.at(-1)!].map((name) => this.short(name));
      this.take("module", `${first} … ${last}`, run);
    }
    for (const name of this.free()) this.take("module", this.short(name), [name]);
    return [...new Set(this.names.map((name) => this.grouped.get(name)!))];
  }

  /** The modules of a mode are a task. */
  private takeTasks(): void {
    const modeOf = (name: string): string => this.modules.get(name)!.mode;
    for (const mode of new Set(this.free().map(modeOf))) {
      if (mode === "") continue;
      const members = this.free().filter((name) => modeOf(name) === mode);
      this.take("task", mode, members, `task:${mode}`);
    }
  }

  /** The modules that steer the robot for a person, and the devices that only they and tasks read. */
  private takePerson(flow: Flow): void {
    const steering = this.state.links.filter(
      ({ to }) => this.decides(moduleOf(to)) && ["person", "stop"].includes(portOf(to)),
    );
    const steers = new Set(steering.map(({ from }) => moduleOf(from)));
    const members = this.free().filter((name) => {
      if (this.bodyOf(name)) return false;
      const writers = [...flow.writers(name)];
      if (steers.has(name) && writers.every((each) => this.decides(each))) return true;
      const readers = [...flow.readers(name)];
      const isSource = readers.length > 0 && writers.length === 0;
      return isSource && readers.every((each) => this.isTask(each) && steers.has(each));
    });
    if (members.length > 0) this.take("person", "person", members, "person:");
  }

  /** Sources that serve only their own body belong to the reader with the fewest readers itself. */
  private takeDetails(flow: Flow): void {
    const details = new Map<string, string[]>();
    for (const name of this.free()) {
      const body = this.bodyOf(name);
      const readers = [...flow.readers(name)];
      const isInside = body && readers.every((each) => this.bodyOf(each) === body);
      if (!isInside || readers.length === 0 || flow.writers(name).size > 0) continue;
      const host = readers.reduce((a, b) => (flow.readers(b).size < flow.readers(a).size ? b : a));
      details.set(host, [...(details.get(host) ?? []), name]);
    }
    for (const [host, others] of details) {
      if (!this.grouped.has(host)) this.take("module", this.short(host), [host, ...others]);
    }
  }

  /** Modules of one program in one body that share a reader are shown as one: "ball ×2". */
  private takeSiblings(flow: Flow): void {
    for (const name of this.free()) {
      if (this.grouped.has(name)) continue;
      const { program } = this.modules.get(name)!;
      const isSibling = (other: string): boolean =>
        this.modules.get(other)!.program === program &&
        this.bodyOf(other) === this.bodyOf(name) &&
        [...flow.readers(other)].some((reader) => flow.readers(name).has(reader));
      const members = this.free().filter((other) => other === name || isSibling(other));
      if (members.length < 2) continue;
      const common = commonName(members.map((each) => this.short(each))) || programName(program);
      this.take("module", `${common} ×${members.length}`, members);
    }
  }

  /** @param key  of a part of several modules; by default that of its first one with a colon. */
  private take(
    kind: PartKind,
    label: string,
    members: readonly string[],
    key = `${members[0]}:`,
  ): void {
    const own = members.length > 1 ? key : members[0]!;
    const part = { key: own, label, kind, members, body: this.bodyOf(members[0]!) };
    for (const member of members) this.grouped.set(member, part);
  }

  private free(): string[] {
    return this.names.filter((name) => !this.grouped.has(name));
  }

  private groupOf(name: string): string {
    return this.modules.get(name)!.group;
  }

  private isTask(name: string): boolean {
    return (this.modules.get(name)?.mode ?? "") !== "";
  }

  /** Whether it is a workspace. */
  private decides(name: string): boolean {
    return name in this.state.focus;
  }

  private bodyOf(name: string): string {
    const group = this.groupOf(name);
    return this.withTasks.has(group) ? "" : group;
  }

  /** Its name without that of its included graph. */
  private short(name: string): string {
    const group = this.groupOf(name);
    return group && name.startsWith(`${group}_`) ? name.slice(group.length + 1) : name;
  }

  /**
   * Whether a module only shows, scores or records: only `readers` read it, in a graph with tasks.
   * A module that only tasks feed moves something instead.
   */
  private isViewer(name: string, readers: ReadonlySet<string>): boolean {
    const writers = [...this.flow.writers(name)];
    const isActor = writers.length > 0 && writers.every((each) => this.isTask(each));
    return (
      this.withTasks.size > 0 &&
      !this.bodyOf(name) &&
      !isActor &&
      [...this.flow.readers(name)].every((reader) => readers.has(reader))
    );
  }
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
