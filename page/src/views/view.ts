// SPDX-License-Identifier: Apache-2.0
import type { Header } from "../mtp";
import type { Arrival, GraphState, Session, Unsubscribe } from "../server";

/** Where messages come from: a stream of the server, or a recording. */
export interface Source {
  /** MODULE.PORT */
  readonly port: string;
  /** Whether its messages are of another time than now. */
  readonly isReplay?: boolean;
  on(event: "message", listener: (arrival: Arrival) => void | Promise<void>): Unsubscribe;
  on(event: "header", listener: (line: string) => void): Unsubscribe;
  on(event: "problem", listener: (problem: string) => void): Unsubscribe;
  /** Asks for no more elements in a row. */
  setWidth(width: number): void;
  /** Starts over, of video with a key frame. */
  restart?(): void;
  close(): void;
}

/** What views may know of the graph. */
export interface Surroundings {
  readonly state: GraphState | undefined;
  readonly session: Session | undefined;
  /** Settled when state and session are known. */
  ready(): Promise<void>;
  /** Opens another source of the same time: live, or of the same recording. */
  open(port: string): Source;
}

export interface ViewHost {
  readonly source: Source;
  readonly surroundings: Surroundings;
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
   * @param sent  header as it was sent, before the server scaled or encoded the message.
   * @returns  where it takes time: when the view is ready for the next one.
   */
  show(arrival: Arrival, sent: Header): void | Promise<void>;
  /** Whether the view itself keeps what was before and scrolls back. */
  readonly keepsPast?: boolean;
  /** Whether it takes messages while nobody sees it: sound is heard. */
  readonly runsUnseen?: boolean;
  /** Of a view that keeps its past: stops or continues with the present. */
  setPaused?(paused: boolean): void;
  /** What is shown now, as a message that can be shown again without others. */
  snapshot?(): Promise<Arrival | undefined>;
  close?(): void;
}

/** A way to show streams. */
export interface ViewKind {
  readonly name: string;
  fits(sent: Header): boolean;
  make(host: ViewHost): View | Promise<View>;
}
