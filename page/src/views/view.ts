// SPDX-License-Identifier: Apache-2.0
import type { Header } from "../mtp";
import type { Output } from "../outputs";
import type { Arrival, GraphState, Session, Unsubscribe } from "../server";

/** A source of messages: a stream of the server, or a recording. */
export interface Source {
  /** MODULE.PORT */
  readonly port: string;
  /** Whether its messages are recorded. */
  readonly isReplay?: boolean;
  on(event: "message", listener: (arrival: Arrival) => void | Promise<void>): Unsubscribe;
  on(event: "header", listener: (line: string) => void): Unsubscribe;
  on(event: "problem", listener: (problem: string) => void): Unsubscribe;
  /** Limits the elements in a row. */
  setWidth(width: number): void;
  /** Restarts; video restarts with a key frame. */
  restart?(): void;
  close(): void;
}

/** The graph, for views. */
export interface Surroundings {
  readonly state: GraphState | undefined;
  readonly session: Session | undefined;
  /** Settled when state and session are known. */
  ready(): Promise<void>;
  /** Opens another source: live, or of the same recording. */
  open(port: string): Source;
  /** All outputs of the module of an output, as it describes them; none if unknown. */
  outputsBeside(port: string): Promise<readonly Output[]>;
  /** All outputs, as their modules describe them. */
  outputs(): Promise<readonly Output[]>;
}

/** What the module of a stream says about it. */
export interface About {
  /** Names of the numbers in a row. */
  readonly columns: readonly string[];
  /** All outputs of the module. */
  readonly outputs: readonly Output[];
}

export interface ViewHost {
  readonly source: Source;
  readonly surroundings: Surroundings;
  readonly about: About;
  say(sentence: string): void;
}

/** Shows the messages of a stream. */
export interface View {
  readonly element: HTMLElement;
  /** Controls for the panel's bar. */
  readonly tools?: readonly HTMLElement[];
  /**
   * Shows a message.
   *
   * @param sent  original header, before the server scaled or encoded the message.
   * @returns  a promise, if it takes time: settled when ready for the next message.
   */
  show(arrival: Arrival, sent: Header): void | Promise<void>;
  /** Whether the view keeps its past and can scroll back. */
  readonly keepsPast?: boolean;
  /** Whether it takes messages while invisible, as sound does. */
  readonly runsUnseen?: boolean;
  /** For a view that keeps its past: pauses or continues. */
  setPaused?(paused: boolean): void;
  /** The current contents as a message that can be shown without earlier ones. */
  snapshot?(): Promise<Arrival | undefined>;
  close?(): void;
}

/** A way to show streams. */
export interface ViewKind {
  readonly name: string;
  fits(sent: Header, about: About): boolean;
  make(host: ViewHost): View | Promise<View>;
}
