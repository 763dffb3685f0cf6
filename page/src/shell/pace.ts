// SPDX-License-Identifier: Apache-2.0

/** Runs frequent actions at most once a period, and always the last one. */
export class Pace {
  private last = -Infinity; // by performance.now() [ms]
  private timer?: ReturnType<typeof setTimeout>;

  /** @param period  [ms] */
  constructor(private readonly period: number) {}

  /** Runs an action now, or at the end of the period unless another one comes before. */
  run(action: () => void): void {
    clearTimeout(this.timer);
    const wait = this.last + this.period - performance.now();
    if (wait > 0) this.timer = setTimeout(() => this.execute(action), wait);
    else this.execute(action);
  }

  close(): void {
    clearTimeout(this.timer);
  }

  private execute(action: () => void): void {
    this.last = performance.now();
    action();
  }
}
