// SPDX-License-Identifier: Apache-2.0
// Which task has the head, as a sentence, and which tasks read the driver's outputs. Pure.
import {
  mayDrive,
  moduleOf,
  programName,
  type Connection,
  type DriveOutput,
  type GraphState,
  type Session,
} from "../server";

/**
 * The task of the module that reads a driver's output, or that a reader without a task serves.
 *
 * @param web  name of the module that serves the page.
 * @returns  its number; 0: none.
 */
export function taskOf(state: GraphState, web: string, output: DriveOutput): number {
  const readersOf = (isRead: (from: string) => boolean): string[] =>
    state.links.filter(({ from }) => isRead(from)).map(({ to }) => moduleOf(to));
  const readers = readersOf((from) => from === `${web}.${output}`);
  for (const reader of [...readers, ...readersOf((from) => readers.includes(moduleOf(from)))]) {
    const mode = state.modules.find(({ name }) => name === reader)?.mode ?? "";
    const task = state.modes[mode];
    if (task) return task;
  }
  return 0;
}

/** Sources of stops that a person knows by another name, by program. */
const stops: Readonly<Record<string, string>> = { hands: "an open palm", web: "a page" };

/** The sources of the stop: "by an open palm (hands.stop)"; "" if it is not known. */
export function stoppedBy(state: GraphState | undefined): string {
  const sources = new Set(Object.values(state?.stopped_by ?? {}).flat());
  const named = [...sources].map((source) => {
    const module = state?.modules.find(({ name }) => name === moduleOf(source));
    const known = module && stops[programName(module.program)];
    return known ? `${known} (${source})` : source;
  });
  return named.length > 0 ? `by ${named.join(", ")}` : "";
}

export interface Situation {
  readonly connection: Connection;
  readonly session: Session | undefined;
  readonly seat: "free" | "waiting" | "held" | "lost";
  /** Why the seat was lost. */
  readonly lost: string;
  /** The page is too slow to drive. */
  readonly slow: boolean;
  /** The graph has a workspace. */
  readonly decides: boolean;
  /** Names of the tasks in focus. */
  readonly focus: readonly string[];
  /** Task for which this page bids; empty: none. */
  readonly bid: string;
  /** The bid is so new that it may be in transit. */
  readonly fresh: boolean;
}

/** A sentence on which task has the head. */
export function whoText(now: Situation): string {
  const { session, seat, focus, bid } = now;
  if (now.connection.status === "lost")
    return now.connection.ended
      ? "The graph has ended."
      : "No connection: it is unknown which task has the head.";
  if (!session) return "";
  if (seat === "waiting") return "Waiting for the seat…";
  const has = focus.join(", ") || "no task";
  if (seat === "held") {
    if (session.stopped) return "Stopped. You have the seat.";
    if (now.slow) {
      const head = now.decides ? ` In focus: ${has}.` : "";
      return `This page is too slow to drive: close other tabs.${head}`;
    }
    if (!now.decides) return "You have the seat.";
    if (!bid) return `The robot decides: ${has}.`;
    if (focus.includes(bid)) return `You hold the head (${bid}).`;
    if (session.stopped === null) return "You do not hold the head: the workspace does not answer.";
    return now.fresh ? `Taking the head (${bid})…` : `You do not hold the head: ${has} has it.`;
  }
  const other = session.driver === "other";
  const who = seat === "lost" ? now.lost : other ? "Somebody else has the seat." : "";
  const head = session.stopped
    ? "Stopped."
    : !now.decides
      ? ""
      : other
        ? `In focus: ${has}.`
        : `The robot decides: ${has}.`;
  const right = mayDrive(session) ? "" : "You may only look; to drive, ask for another URL.";
  return [who, head, right].filter((words) => words !== "").join(" ") || "The seat is free.";
}
