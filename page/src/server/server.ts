// SPDX-License-Identifier: Apache-2.0
import { readMessage, rowsOf } from "../mtp";
import { Drive } from "./drive";
import { Signal } from "./signal";
import { Socket } from "./socket";
import { Standings } from "./standings";
import { Stream, type StreamOptions } from "./stream";
import type { Connection, GraphState, LogLine, Recording, Session } from "./types";

/** A failed command; `rows` are the error. */
export class CommandError extends Error {
  constructor(readonly rows: readonly string[]) {
    super(rows.join("\n"));
    this.name = "CommandError";
  }
}

interface Waiting {
  resolve(rows: string[]): void;
  reject(error: CommandError): void;
}

const logLines = 2000;
/** Close code of a server that leaves, because its graph ends or it is restarted. */
const serverLeaves = 1001;
/** A server that has left for longer is not restarted [ms]. */
const restartTime = 3000;

/** The server of this page: the graph's state, the session, the bids, the log, commands, streams. */
export class Server {
  private readonly states = new Signal<GraphState>();
  private readonly sessions = new Signal<Session>();
  private readonly lines = new Signal<LogLine>();
  private readonly connections = new Signal<Connection>({ status: "connecting" });
  readonly onState = this.states.on;
  readonly onSession = this.sessions.on;
  readonly onConnection = this.connections.on;
  /** New lines of the log (G46); earlier ones are in `log`. */
  readonly onLog = this.lines.on;
  readonly standings = new Standings();
  private readonly waiting = new Map<bigint, Waiting>(); // by the number of the command
  private asked = 0n; // over this connection
  private readonly logged: LogLine[] = [];
  private leftAt = Infinity; // by performance.now() [ms]
  private readonly socket: Socket;

  constructor() {
    this.socket = new Socket(() => "/graph", {
      open: () => {
        this.logged.length = 0; // the server sends the last lines again
        this.asked = 0n;
        this.leftAt = Infinity;
        this.connections.set({ status: "open" });
      },
      binary: (bytes) => this.receive(bytes),
      lost: (code, reason, retry) => {
        const { session } = this;
        if (session) this.sessions.set({ ...session, stopped: null }); // unknown now
        this.standings.clear();
        if (code === serverLeaves) this.leftAt = performance.now();
        const ended = performance.now() - this.leftAt > restartTime;
        if (ended) this.end();
        this.connections.set({ status: "lost", why: whyLost(ended, reason), retry, ended });
        const lost = [...this.waiting.values()];
        this.waiting.clear();
        for (const each of lost) {
          each.reject(
            new CommandError(["The connection was lost; the command may not have been executed."]),
          );
        }
      },
    });
  }

  get state(): GraphState | undefined {
    return this.states.value;
  }

  get session(): Session | undefined {
    return this.sessions.value;
  }

  /** Settled when the state and the session are known. */
  async ready(): Promise<void> {
    await this.states.first();
    await this.sessions.first();
  }

  get connection(): Connection {
    return this.connections.value ?? { status: "connecting" };
  }

  /** The last lines of the log. */
  get log(): readonly LogLine[] {
    return this.logged;
  }

  /**
   * Sends commands, a row each (W7).
   *
   * @returns  the rows after `ok`.
   * Errors: CommandError with the rows of the error.
   */
  command(text: string): Promise<string[]> {
    return new Promise((resolve, reject) => {
      if (this.socket.send(text)) this.waiting.set(this.asked++, { resolve, reject });
      else reject(new CommandError(["No connection to the server."]));
    });
  }

  /** Opens the stream MODULE.PORT. */
  stream(port: string, options: StreamOptions = {}): Stream {
    return new Stream(port, options);
  }

  /** Opens the driver's seat. */
  drive(options: { take?: boolean } = {}): Drive {
    return new Drive(options.take ?? false);
  }

  /** The recordings on the server (W14). */
  async recordings(): Promise<Recording[]> {
    const response = await fetch("/recordings");
    if (!response.ok)
      throw new Error(`The server refuses the list of recordings: ${response.status}.`);
    return (await response.json()) as Recording[];
  }

  /** Connects at once instead of waiting. */
  reconnect(): void {
    this.socket.retry();
  }

  /** The graph has ended: so have its modules, and no task has the focus. */
  private end(): void {
    const { state, session } = this;
    if (state) {
      const idle = { status: "ended", in_workspace: false } as const;
      const ended = { ...idle, pid: 0, cpu: 0, memory: 0, detail: "", in_focus: false };
      const modules = state.modules.map((each) => ({ ...each, ...ended }));
      const silent = { ...idle, per_second: 0, bytes_per_second: 0, age: null };
      const links = state.links.map((link) => ({ ...link, ...silent }));
      const focus = Object.fromEntries(Object.keys(state.focus).map((name) => [name, null]));
      this.states.set({ ...state, modules, links, focus });
    }
    if (session) this.sessions.set({ ...session, driver: null, recording: null, drives: [] });
  }

  private receive(bytes: Uint8Array<ArrayBuffer>): void {
    const message = readMessage(bytes);
    const rows = rowsOf(message);
    switch (message.header.src) {
      case 1: {
        const state = JSON.parse(rows.join("")) as GraphState;
        this.standings.follow(state);
        return this.states.set(state);
      }
      case 2: {
        const said = JSON.parse(rows.join("")) as Omit<LogLine, "at">;
        const line = { ...said, at: Number(message.header.time) / 1e6 };
        this.logged.push(line);
        if (this.logged.length > logLines) this.logged.shift();
        return this.lines.emit(line);
      }
      case 3:
        return this.sessions.set(JSON.parse(rows.join("")) as Session);
      case 4: {
        const [first, ...others] = rows;
        const answer = this.waiting.get(message.header.seq);
        this.waiting.delete(message.header.seq);
        if (first === "ok") answer?.resolve(others);
        else answer?.reject(new CommandError(rows));
      }
    }
  }
}

function whyLost(ended: boolean, reason: string): string {
  if (ended) return "The graph has ended. Start it again, then open the URL that it prints.";
  const detail = reason && `The server says: ${reason}. `;
  return `${detail}It is unknown whether the robot is stopped. If the graph was restarted, open the URL that it prints.`;
}
