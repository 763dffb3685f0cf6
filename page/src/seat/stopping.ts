// SPDX-License-Identifier: Apache-2.0
// What became of a press of the stop: pure; time is handed in [ms].

/** So long the server has to answer; it gives the workspace 500 ms. */
const patience = 800;

/** What a person wants of the stop, until it is known to be so. */
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

  /** The workspace says how it is, after an order. */
  heard(isStopped: boolean | null): void {
    if (isStopped !== null && this.wanted?.stops === isStopped) this.settle();
  }

  /** A clear that was not done is no danger, so it is told once. */
  forgetClear(): void {
    if (this.wanted?.stops === false) this.settle();
  }

  /** Whether the stop is to be sent once more when it can be. */
  get isUnconfirmed(): boolean {
    return this.wanted?.stops === true;
  }

  /** Why a stop that was pressed may not have arrived; empty: it has, or it is too early to say. */
  alarm(now: number): string {
    if (!this.wanted?.stops) return "";
    if (!this.isConnected)
      return "The page has no connection to its server. The stop is sent as soon as there is one.";
    if (this.problem !== "") return this.problem;
    return now - this.wanted.since > patience ? "The server of the page does not answer." : "";
  }

  private settle(): void {
    this.wanted = undefined;
    this.problem = "";
  }
}
