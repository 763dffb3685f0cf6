// SPDX-License-Identifier: Apache-2.0
// The state of the graph and the session from the server, as far as used by the page: JSON of G45
// (spec/graph.md) and W6 (spec/page.md).

export type ModuleStatus =
  "starting" | "running" | "stalled" | "waiting" | "stopping" | "ended" | "given up";

/** Median, 99th percentile and maximum [s]. */
export type Percentiles = readonly [number, number, number];

export interface GraphModule {
  readonly name: string;
  readonly program: string;
  /** The included graph to which it belongs; empty: the file itself. */
  readonly group: string;
  readonly pid: number;
  readonly status: ModuleStatus;
  readonly detail: string;
  readonly restarts: number;
  readonly exit: number | null;
  /** Part of one processor. */
  readonly cpu: number;
  /** [byte] */
  readonly memory: number;
  readonly mode: string;
  readonly modes: readonly string[];
  /** The workspace whose focus it obeys; empty: none. */
  readonly workspace: string;
  readonly in_focus: boolean;
  readonly in_workspace: boolean;
  /** Of its log. */
  readonly last_line: string;
  readonly last_level: Level;
  readonly parameters: Readonly<Record<string, string>>;
}

export interface GraphLink {
  readonly from: string;
  readonly to: string;
  /** Why it is not connected; empty if it is. */
  readonly status: string;
  readonly keep: string | number;
  readonly rate: number;
  /** Limit [byte/s]; 0: none. */
  readonly bandwidth: number;
  /** Quality of JPEG and scale of images, as they are adapted to the bandwidth. */
  readonly images: readonly [number, number] | null;
  readonly messages: number;
  readonly bytes: number;
  readonly per_second: number;
  readonly bytes_per_second: number;
  readonly delayed: number;
  readonly throttled: number;
  readonly dropped_newer: number;
  readonly dropped_memory: number;
  readonly dropped_disconnect: number;
  readonly dropped_timeout: number;
  readonly ignored: number;
  readonly in_workspace: boolean;
  readonly age: Percentiles | null;
}

export interface Focus {
  readonly mode: string;
  readonly number: number;
}

export type Level = "info" | "warning" | "error" | "result";

/** A line of the graph's log (G46). */
export interface LogLine {
  readonly module: string;
  readonly level: Level;
  readonly text: string;
  /** When the server got it [ms since 1970]. */
  readonly at: number;
}

export interface GraphState {
  readonly graph: string;
  readonly file: string;
  readonly pid: number;
  /** [s] */
  readonly uptime: number;
  readonly status: "running" | "stopping";
  /** The mode in focus, by workspace. */
  readonly focus: Readonly<Record<string, Focus | null>>;
  /** The sources that have stopped the robot, by workspace. */
  readonly stopped_by: Readonly<Record<string, readonly string[]>>;
  readonly modules: readonly GraphModule[];
  readonly links: readonly GraphLink[];
  readonly modes: Readonly<Record<string, number>>;
}

/** Name of the module of `MODULE.PORT`. */
export function moduleOf(port: string): string {
  return port.slice(0, port.indexOf("."));
}

/** Name of the port of `MODULE.PORT`. */
export function portOf(port: string): string {
  return port.slice(port.indexOf(".") + 1);
}

/** Name of a program, without its folder. */
export function programName(program: string): string {
  return program.split("/").at(-1) ?? program;
}

/** Name of a mode; "mode 7" if it has none. */
export function modeName(state: GraphState | undefined, mode: number): string {
  const found = Object.entries(state?.modes ?? {}).find(([, number]) => number === mode);
  return found?.[0] ?? `mode ${mode}`;
}

/** The modes in focus, in the order of the workspaces' names. */
export function modesInFocus(state: GraphState | null | undefined): Focus[] {
  return Object.values(state?.focus ?? {}).filter((focus) => focus !== null);
}

export type DriveOutput = "stick" | "rotation" | "target" | "text" | "bid" | "name" | "hold";

export interface RecordingState {
  readonly name: string;
  readonly bytes: number;
  readonly seconds: number;
  readonly streams: readonly string[];
}

/** Rights of a session; each includes those before it. */
export type Right = "view" | "drive" | "operate";

export interface Session {
  readonly right: Right;
  readonly driver: "other" | null;
  /** null: no workspace, it is silent, or no connection. */
  readonly stopped: boolean | null;
  readonly recording: RecordingState | null;
  readonly drives: readonly DriveOutput[];
  /** The text of G31. */
  readonly frames: string;
  /** Name of the module that serves this page. */
  readonly web: string;
}

/** Whether a session may take the seat and clear a stop. */
export function mayDrive(session: Session | undefined): boolean {
  return session?.right === "drive" || session?.right === "operate";
}

/** Whether a session may change the graph, record and invite. */
export function mayOperate(session: Session | undefined): boolean {
  return session?.right === "operate";
}

export interface Recording {
  readonly name: string;
  readonly bytes: number;
  readonly streams: readonly string[];
  /** Why it cannot be read. */
  readonly problem?: string;
}

/** The connection to the server. */
export type Connection =
  | { readonly status: "connecting" }
  | { readonly status: "open" }
  /** `retry`: seconds until the next try; null: only on request. `ended`: the graph has ended. */
  | {
      readonly status: "lost";
      readonly why: string;
      readonly retry: number | null;
      readonly ended: boolean;
    };
