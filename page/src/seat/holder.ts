// SPDX-License-Identifier: Apache-2.0
// Holds the driver's socket, and repeats a person's commands while they last.
import { Coord, headerOf, numbersMessage, textMessage, type Kind, type Message } from "../mtp";
import { Signal, type Drive, type DriveOutput, type Server } from "../server";
import type { Angles } from "./orientation";
import { Stick } from "./steering";
import { WallClock } from "./wall_clock";

export type SeatState =
  | { readonly is: "free" }
  | { readonly is: "waiting" }
  | { readonly is: "held" }
  /** `why`: a sentence. */
  | { readonly is: "lost"; readonly why: string };

const period = 33; // of the stick [ms]
const bidPeriod = 100; // [ms]

/** Silence after which the server withdraws a page's commands (W13) [ms]. */
const deadMan = 200;
/** How long a page counts as slow after a late command [ms]. */
const slowFor = 3000;

/** A head that turns less is at rest [rad]. */
const still = 0.01;
/** A larger turn takes the robot's head back from a hand or a chosen task [rad]. */
const turns = 0.1;
/** How long a new bid may be in transit [ms]. */
const onItsWay = 1500;

/**
 * The supervisor's seat. Taking it takes the head: the page bids for the task that steers, until
 * another is chosen or the head is released. Hiding the page leaves the seat, since a person must
 * see the robot to drive it.
 */
export class Seat {
  readonly stick = new Stick();
  private readonly clock = new WallClock();
  private readonly states = new Signal<SeatState>({ is: "free" });
  private readonly tasks = new Signal<number>(0);
  private readonly holds = new Signal<number>(0);
  readonly onState = this.states.on;
  readonly onTask = this.tasks.on;
  readonly onHeld = this.holds.on;
  private drive?: Drive;
  private steering = false;
  /** When this page last sent a command, and when it was last too late [ms]. */
  private lastTurn = -Infinity;
  private lastLate = -Infinity;
  /** The person's head when it last moved. */
  private turned: Angles = { roll: 0, pitch: 0, yaw: 0 };
  /** The person's head when another input took the robot's head. */
  private aside?: Angles;
  private chosenAt = -Infinity; // [ms]
  private readonly timers: number[];
  private readonly hidden = (): void => {
    if (document.hidden && this.drive) this.leave("You left the page and lost the seat.");
  };

  /**
   * @param taskOf  number of the task that reads an output; 0: none.
   * @param say  shows the person an error.
   * @param commanded  called with the time of each message that moves the head [ms since the Unix epoch].
   */
  constructor(
    private readonly server: Server,
    private readonly taskOf: (output: DriveOutput) => number,
    private readonly say: (sentence: string) => void,
    private readonly commanded: (at: number) => void,
  ) {
    this.timers = [
      window.setInterval(() => this.steer(), period),
      window.setInterval(() => this.bid(), bidPeriod),
    ];
    document.addEventListener("visibilitychange", this.hidden);
  }

  close(): void {
    this.leave();
    this.timers.forEach((timer) => clearInterval(timer));
    document.removeEventListener("visibilitychange", this.hidden);
  }

  get state(): SeatState {
    return this.states.value ?? { is: "free" };
  }

  get isHeld(): boolean {
    return this.state.is === "held";
  }

  /** Whether commands expire, because the page or the machine is overloaded. */
  get isSlow(): boolean {
    return this.isHeld && performance.now() - this.lastLate < slowFor;
  }

  /** Whether the bid is so new that the workspace may not have received it. */
  get isFresh(): boolean {
    return performance.now() - this.chosenAt < onItsWay;
  }

  /** Number of the chosen task; 0: none. */
  get task(): number {
    return this.tasks.value ?? 0;
  }

  /** Track of the person who is held; 0: nobody. */
  get held(): number {
    return this.holds.value ?? 0;
  }

  /** @param fromOther  takes it from another page. */
  take(fromOther = false): void {
    this.drive?.close();
    const drive = this.server.drive({ take: fromOther });
    this.drive = drive;
    this.states.set({ is: "waiting" });
    drive.onRefusal((why) => this.say(`Not done: ${why}.`));
    let isNew = true;
    drive.onStatus((status) => {
      if (this.drive !== drive) return;
      if (status.status === "driving") {
        this.states.set({ is: "held" });
        if (isNew) this.choose(this.taskOf("stick"));
        isNew = false;
        return;
      }
      if (status.status === "connecting") return this.states.set({ is: "waiting" });
      this.forget({ is: "lost", why: status.why });
    });
  }

  /** Leaves the seat. @param why  reason, if not the person's decision. */
  leave(why = ""): void {
    if (!this.drive) return;
    this.stick.release();
    if (this.steering) this.sendStick();
    if (this.task) this.sendBid(this.task, 0);
    if (this.held) this.sendHold(0);
    this.drive.close();
    this.forget(why ? { is: "lost", why } : { is: "free" });
  }

  /** Bids for a task in the person's name, until it is released. */
  choose(task: number): void {
    if (task !== this.task) this.chosenAt = performance.now();
    this.aside = undefined;
    this.tasks.set(task);
    this.bid();
  }

  /** Lets the robot decide. */
  release(): void {
    if (this.task) this.sendBid(this.task, 0);
    this.choose(0);
  }

  /** From now on, the person's head turns the robot's. */
  orient(): void {
    if (this.isHeld) this.choose(this.taskOf("rotation"));
  }

  /** Takes the orientation of the person's head relative to its zero. */
  turn(angles: Angles): void {
    if (!this.isHeld || this.steering || !this.mayTurn(angles)) return;
    const { roll, pitch, yaw } = angles;
    const time = this.clock.now();
    const message = numbersMessage("rotation", [roll, pitch, yaw], {
      coord: Coord.supervisor,
      time: nanoseconds(time),
    });
    if (!this.drive?.send("rotation", message)) return;
    const { pitch: p, yaw: y } = this.turned;
    if (Math.hypot(pitch - p, yaw - y) < still) return;
    this.turned = { roll, pitch, yaw };
    this.commanded(time);
  }

  /**
   * Looks at a pixel of a camera image.
   *
   * @param coord  7: left eye, 8: right eye.
   * @param time  of that image [ns].
   */
  lookAt(x: number, y: number, coord: number, time: bigint): void {
    this.claim("target");
    const message = numbersMessage("position", [x, y, 0], { coord, time });
    if (this.drive?.send("target", message)) this.commanded(this.clock.now());
  }

  /**
   * Speaks a text with the robot's voice; returns whether it was sent.
   *
   * @param mode  of the task in focus; only that may speak.
   */
  speak(text: string, mode: number): boolean {
    return this.drive?.send("text", textMessage(text, { coord: Coord.text, mode })) ?? false;
  }

  /** Gives a person a name; returns whether it was sent. */
  name(track: number, name: string): boolean {
    const message = textMessage(`${track} ${name}`, { coord: Coord.text });
    return this.drive?.send("name", message) ?? false;
  }

  /** Looks at a person, by their track, until 0 releases them; returns whether it was sent. */
  hold(track: number): boolean {
    if (!this.sendHold(track)) return false;
    this.holds.set(track);
    if (track) this.claim("hold");
    else if (this.task && this.task === this.taskOf("hold")) this.release();
    return true;
  }

  /** Sends the stick while it is pushed, and its centre once at the end. */
  private steer(): void {
    const now = performance.now();
    const isLate = now - this.lastTurn > deadMan;
    this.lastTurn = now;
    if (!this.isHeld) return;
    if (isLate) this.lastLate = now;
    const { left, down } = this.stick.push;
    const pushed = left !== 0 || down !== 0;
    if (pushed) this.claim("stick"); // the hand has priority
    if (pushed || this.steering) this.sendStick();
    this.steering = pushed;
  }

  private sendStick(): void {
    const { left, down } = this.isHeld ? this.stick.push : { left: 0, down: 0 };
    const time = this.clock.now();
    if (this.drive?.send("stick", stickMessage(left, down, nanoseconds(time))) && !this.steering)
      this.commanded(time);
  }

  private bid(): void {
    if (this.task) this.sendBid(this.task, 1);
    if (this.held) this.sendHold(this.held);
  }

  /** Bids for the task that reads an output, instead of another. */
  private claim(output: DriveOutput): void {
    const task = this.taskOf(output);
    if (task && task !== this.task) this.choose(task);
  }

  /** Whether to follow the person's head: after a hand or another task, once it has turned. */
  private mayTurn({ roll, pitch, yaw }: Angles): boolean {
    const task = this.taskOf("rotation");
    if (!task || task === this.task) return true;
    this.aside ??= { roll, pitch, yaw };
    if (Math.hypot(pitch - this.aside.pitch, yaw - this.aside.yaw) < turns) return false;
    this.choose(task);
    return true;
  }

  private sendBid(mode: number, salience: number): void {
    if (this.isHeld) this.drive?.send("bid", numbersMessage("table", [salience], { mode }));
  }

  private sendHold(track: number): boolean {
    return this.isHeld && (this.drive?.send("hold", numbersMessage("table", [track])) ?? false);
  }

  private forget(state: SeatState): void {
    this.drive = undefined;
    this.steering = false;
    this.stick.release();
    this.tasks.set(0);
    this.holds.set(0);
    this.states.set(state);
  }
}

const stickKind: Kind = { type: "table", components: 1, scalar: "f64", encoding: "binary" };

/** A message for the output `stick`. */
function stickMessage(left: number, down: number, time: bigint): Message {
  return { header: headerOf(stickKind, 2, 1, { time }), elements: Float64Array.of(left, down) };
}

function nanoseconds(ms: number): bigint {
  return BigInt(Math.round(ms * 1e3)) * 1000n;
}
