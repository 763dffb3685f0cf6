// SPDX-License-Identifier: Apache-2.0
// Tracks a press of the stop until it is confirmed. Pure; times come from the caller [ms].

/** How long an order may be unanswered before the page says so [ms]. */
export const patience = 250;

/** A person's order, until it is confirmed. */
export class Stopping {
  private wanted?: { readonly stops: boolean; readonly since: number };
  private problem = "";
  private isConnected = false;

  /** The stop is pressed, or cleared. */
  press(stops: boolean, now: number): void {
    const isSame = this.wanted?.stops === stops;
    if (!isSame) this.problem = "";
    this.wanted = isSame ? this.wanted : { stops, since: now };
  }

  connected(isConnected: boolean): void {
    this.isConnected = isConnected;
  }

  /** The server has answered. @param problem  empty: the workspace has confirmed the order. */
  answered(stops: boolean, problem: string): void {
    if (this.wanted?.stops !== stops) return;
    if (problem === "") this.settle();
    else this.problem = problem;
  }

  /** Takes the workspace's state after an order. */
  heard(isStopped: boolean | null): void {
    if (isStopped !== null && this.wanted?.stops === isStopped) this.settle();
  }

  /** A failed clear is not dangerous, so it is reported once. */
  forgetClear(): void {
    if (this.wanted?.stops === false) this.settle();
  }

  /** Whether to send the stop again. */
  get isUnconfirmed(): boolean {
    return this.wanted?.stops === true;
  }

  /** Why a stop may not have arrived; empty if confirmed, or too early to tell. */
  alarm(now: number): string {
    if (!this.wanted?.stops) return "";
    if (!this.isConnected)
      return "The page has no connection to its server. The stop is sent as soon as there is one.";
    if (this.problem !== "") return this.problem;
    return now - this.wanted.since < patience ? "" : "There is no answer yet.";
  }

  private settle(): void {
    this.wanted = undefined;
    this.problem = "";
  }
}
