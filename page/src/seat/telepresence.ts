// SPDX-License-Identifier: Apache-2.0
// Telepresence with the orientation of a phone.
import { anglesOfDevice, since, type Angles } from "./orientation";

/** Time within which a sensor reports its first orientation [ms]. */
const patience = 1500;
/** Period at which the last orientation is repeated, since a phone at rest sends no events [ms]. */
const period = 40;

type WithPermission = typeof DeviceOrientationEvent & {
  requestPermission?(): Promise<"granted" | "denied">;
};

export class PhoneTracker {
  private zeroed?: Angles;
  private last?: Angles;
  private timer = 0;
  private waiting = 0; // the timer that waits for the first orientation

  /**
   * @param turned  called with the phone's orientation relative to its zero.
   * @param missing  called with a sentence if there is no sensor; the tracker has stopped then.
   */
  constructor(
    private readonly turned: (angles: Angles) => void,
    private readonly missing: (why: string) => void,
  ) {}

  get isOn(): boolean {
    return this.timer !== 0;
  }

  /** Starts; the first orientation is straight ahead. Errors: a sentence. */
  async start(): Promise<void> {
    if (!("DeviceOrientationEvent" in window)) {
      throw new Error("This browser does not report the device's orientation.");
    }
    const permission = await (DeviceOrientationEvent as WithPermission).requestPermission?.();
    if (permission === "denied") {
      throw new Error(
        "The browser may not read the device's orientation: allow access to motion sensors.",
      );
    }
    this.zero();
    addEventListener("deviceorientation", this.take);
    this.timer = window.setInterval(() => this.say(), period);
    this.waiting = window.setTimeout(() => this.giveUp(), patience);
  }

  stop(): void {
    removeEventListener("deviceorientation", this.take);
    clearInterval(this.timer);
    clearTimeout(this.waiting);
    this.timer = 0;
    this.last = undefined;
  }

  /** Makes the current orientation straight ahead. */
  zero(): void {
    this.zeroed = this.last;
  }

  private readonly take = (event: DeviceOrientationEvent): void => {
    const { alpha, beta, gamma } = event;
    if (alpha === null || beta === null || gamma === null) return this.giveUp();
    clearTimeout(this.waiting);
    this.last = anglesOfDevice(alpha, beta, gamma, screen.orientation?.angle ?? 0);
    this.zeroed ??= this.last;
    this.say();
  };

  private giveUp(): void {
    this.stop();
    this.missing(
      isSecureContext
        ? "This device has no motion sensor, so it cannot turn the head."
        : "The browser gives the motion sensor only to pages over HTTPS: run the graph with --listen.",
    );
  }

  private say(): void {
    if (this.last && this.zeroed) this.turned(since(this.zeroed, this.last));
  }
}
