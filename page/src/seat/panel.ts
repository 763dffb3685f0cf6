// SPDX-License-Identifier: Apache-2.0
// The supervisor's seat: the robot's images, and the controls to move it.
import { mayDrive, modeName, modesInFocus, type DriveOutput, type GraphState } from "../server";
import { earsOf } from "../eyes";
import { outputsOf } from "../outputs";
import { People } from "../people";
import { button, h, meanings, setText, type PanelHost, type PanelKind } from "../shell";
import { Ears } from "./ears";
import { GazeHistory, headOutput } from "./gaze";
import { dragSteers, gamepadsSteer, keysSteer } from "./hands";
import { Seat, type SeatState } from "./holder";
import { Hud } from "./hud";
import { Latency } from "./latency";
import { SeatPeople } from "./people";
import { TaskButtons } from "./tasks";
import { PhoneTracker } from "./telepresence";
import { SeatView } from "./view";
import { taskOf, whoText } from "./who";
import type { XrView } from "./xr";

declare global {
  interface Window {
    /** Motion-to-photon latency, for tests and benchmarks. */
    hypercolumn?: { latency: Latency };
  }
}

/** The supervisor's seat: {kind: "seat"}. */
export const seatPanel: PanelKind = (_args, host) => {
  host.setTitle("Seat");
  return new SeatPanel(host);
};

class SeatPanel {
  private readonly latency = new Latency();
  private readonly seat: Seat;
  private readonly view: SeatView;
  private readonly people: People;
  private readonly persons: SeatPeople;
  private readonly hud: Hud;
  private readonly tasks: TaskButtons;
  private readonly phone: PhoneTracker;
  private xr?: XrView;
  private isClosed = false;
  private gaze?: GazeHistory;
  private ears?: Ears;
  private readonly ends: (() => void)[] = [];

  private readonly who = h("p.seat-who", { role: "status" });
  private readonly takeButton = button("Take the seat", () => this.take(), {
    class: "primary",
    title: meanings.seat,
  });
  private readonly leaveButton = button("Leave the seat", () => this.seat.leave());
  private readonly knob = h("div.knob");
  private readonly pad = h(
    "div.pad",
    { "aria-hidden": "true", title: "Drag to turn the head" },
    this.knob,
  );
  private readonly phoneButton = button("Turn with this phone", () => void this.togglePhone(), {
    "aria-pressed": "false",
  });
  private readonly xrButton = button("Enter the headset", () => void this.toggleXr(), {
    hidden: true,
  });
  private readonly zeroButton = button("This is straight ahead", () => {
    this.phone.zero();
    this.xr?.zero();
    if (this.phone.isOn || this.xr) this.seat.orient();
  });
  private readonly text = h("input", {
    type: "text",
    id: "seat-text",
    maxlength: 500,
    placeholder: "Say something",
  });
  private readonly speakButton = h("button", { type: "submit" }, "Say it");
  private readonly listenButton = button("Listen", () => this.toggleEars(), {
    "aria-pressed": "false",
  });
  readonly element: HTMLElement;

  constructor(private readonly host: PanelHost) {
    const { server } = host;
    this.seat = new Seat(
      server,
      (output) => {
        const { state, session } = server;
        return state && session ? taskOf(state, session.web, output) : 0;
      },
      (sentence) => host.say(sentence),
      (at) => this.latency.command(at),
    );
    this.people = new People({
      get state() {
        return server.state;
      },
      outputs: () => outputsOf(server),
      open: (port) => server.stream(port),
    });
    this.view = new SeatView(server, this.latency, this.people);
    this.persons = new SeatPeople(
      server,
      this.seat,
      this.people,
      (output) => this.has(output),
      (sentence) => host.say(sentence),
    );
    this.hud = new Hud(server, this.latency);
    this.view.element.append(this.hud.element, this.persons.form);
    this.tasks = new TaskButtons(server, this.seat, () => this.seat.isHeld && this.has("bid"));
    this.phone = new PhoneTracker(
      (angles) => this.seat.turn(angles),
      (why) => {
        this.showPhone();
        host.say(why);
      },
    );
    window.hypercolumn = { latency: this.latency };

    const speak = h(
      "form.speak.row",
      {
        onsubmit: (event: SubmitEvent) => {
          event.preventDefault();
          const text = this.text.value.trim();
          const mode = modesInFocus(server.state)[0]?.number ?? 0;
          if (!text || !this.seat.speak(text, mode)) return;
          this.text.value = "";
          host.say(`Sent to the robot's voice: ${text}`);
        },
      },
      [h("label.unseen", { for: "seat-text" }, "Say"), this.text, this.speakButton],
    );
    this.element = h(
      "div.seat",
      {
        tabindex: 0,
        role: "group",
        "aria-label": "Seat: arrow keys or W A S D turn the head while you have the seat",
      },
      [
        h("div.seat-grid", [
          this.view.element,
          h("div.seat-hands", [
            h("div.seat-hold", [this.who, this.takeButton, this.leaveButton]),
            h("div.pad-place", [
              this.pad,
              h("p.pad-hint.muted.small", "drag · arrow keys · gamepad · click in the image"),
            ]),
          ]),
          h("div.seat-choices", [
            this.tasks.element,
            this.persons.list,
            speak,
            h("div.seat-more.wrap", [
              this.phoneButton,
              this.xrButton,
              this.zeroButton,
              this.listenButton,
            ]),
          ]),
        ]),
      ],
    );

    this.bindHands();
    this.ends.push(
      this.seat.onState((state) => this.showSeat(state)),
      this.seat.onTask(() => server.state && this.tasks.update(server.state)),
      server.onState((state) => this.showState(state)),
      server.onSession((session) => {
        this.hud.update(session);
        this.showWho();
      }),
      server.onConnection(() => server.state && this.showState(server.state)),
    );
    void navigator.xr?.isSessionSupported("immersive-vr").then(
      (supported) => (this.xrButton.hidden = !supported),
      () => {},
    );
    const timer = window.setInterval(() => {
      this.hud.showLatency();
      this.showWho();
      this.persons.update();
    }, 500);
    this.ends.push(() => clearInterval(timer));
  }

  close(): void {
    this.isClosed = true;
    for (const end of this.ends) end();
    if (this.seat.isHeld) this.host.say("You have left the seat.");
    this.phone.stop();
    this.xr?.leave();
    this.ears?.close();
    this.gaze?.close();
    this.hud.close();
    this.tasks.close();
    this.persons.close();
    this.people.close();
    this.view.close();
    this.seat.close();
  }

  private bindHands(): void {
    const { stick } = this.seat;
    const { canvas } = this.view;
    const show = ({ left, down }: { left: number; down: number }): void => {
      const pushed = left !== 0 || down !== 0;
      if (pushed && !this.seat.isHeld) return this.host.say("Take the seat first, then steer.");
      const reach = this.pad.clientWidth * 0.3;
      this.knob.style.transform = `translate(${-left * reach}px, ${down * reach}px)`;
    };
    dragSteers(this.pad, stick, "pad", () => this.pad.clientWidth / 2, show);
    const reach = (): number => Math.min(canvas.clientWidth, canvas.clientHeight) / 3;
    dragSteers(canvas, stick, "image", reach, show, (event) => this.lookAt(event));
    canvas.addEventListener("pointermove", ({ clientX, clientY }) => {
      canvas.classList.toggle("on-person", this.view.personAt(clientX, clientY) !== undefined);
    });
    keysSteer(this.element, stick);
    this.ends.push(gamepadsSteer(stick));
  }

  private lookAt(event: PointerEvent): void {
    const person = this.view.personAt(event.clientX, event.clientY);
    if (person) return this.persons.click(person);
    if (!this.seat.isHeld) return this.host.say("Take the seat first, then point.");
    if (!this.has("target"))
      return this.host.say("No face is known here, and nothing in this graph turns to a pixel.");
    const pixel = this.view.pixelAt(event.clientX, event.clientY);
    if (!pixel) return this.host.say("Point at an unprocessed camera image.");
    this.seat.lookAt(pixel.x, pixel.y, pixel.coord, pixel.time);
    this.host.say(`Asked to look at pixel ${Math.round(pixel.x)}, ${Math.round(pixel.y)}.`);
  }

  private take(): void {
    this.seat.take(this.host.server.session?.driver === "other");
    this.element.focus();
  }

  private has(output: DriveOutput): boolean {
    return this.host.server.session?.drives.includes(output) ?? false;
  }

  private async togglePhone(): Promise<void> {
    if (this.phone.isOn) {
      this.phone.stop();
    } else {
      try {
        await this.phone.start();
        this.seat.orient();
      } catch (error) {
        this.host.say(error instanceof Error ? error.message : String(error));
      }
    }
    this.showPhone();
  }

  private showPhone(): void {
    this.phoneButton.setAttribute("aria-pressed", String(this.phone.isOn));
  }

  private async toggleXr(): Promise<void> {
    if (this.xr) return this.xr.leave();
    const { server } = this.host;
    try {
      const { XrView } = await import("./xr");
      const pose = headOutput(server.session?.frames ?? "");
      if (pose && !this.gaze) this.gaze = new GazeHistory(server, pose);
      const xr = await XrView.enter({
        focal: this.view.focal,
        turned: (angles) => this.seat.turn(angles),
        gazeAt: (time) => this.gaze?.at(time),
        ended: () => {
          this.xr = undefined;
          this.view.showIn(undefined);
          this.xrButton.textContent = "Enter the headset";
        },
      });
      if (this.isClosed) return xr.leave();
      this.xr = xr;
      this.seat.orient();
      this.view.showIn(xr);
      this.xrButton.textContent = "Leave the headset";
    } catch (error) {
      this.host.say(error instanceof Error ? error.message : String(error));
    }
  }

  private toggleEars(): void {
    const { server } = this.host;
    const port = server.state && earsOf(server.state);
    if (this.ears) {
      this.ears.close();
      this.ears = undefined;
    } else if (port) {
      this.ears = new Ears(server, port);
    }
    this.listenButton.setAttribute("aria-pressed", String(this.ears !== undefined));
  }

  private showSeat(state: SeatState): void {
    if (state.is !== "held") {
      this.phone.stop();
      this.showPhone();
      this.xr?.leave();
    }
    this.element.classList.toggle("held", state.is === "held");
    this.showWho();
    this.persons.update();
    if (this.host.server.state) this.tasks.update(this.host.server.state);
  }

  private showState(state: GraphState): void {
    this.view.update(state);
    this.listenButton.disabled = earsOf(state) === undefined;
    this.tasks.update(state);
    this.showWho();
  }

  /** Shows which task has the head, and the choices. */
  private showWho(): void {
    const { session, state, connection } = this.host.server;
    const { seat } = this;
    const text = whoText({
      connection,
      session,
      seat: seat.state.is,
      lost: seat.state.is === "lost" ? seat.state.why : "",
      slow: seat.isSlow,
      decides: Object.keys(state?.focus ?? {}).length > 0,
      focus: modesInFocus(state).map((focus) => focus.mode),
      bid: seat.task && state ? modeName(state, seat.task) : "",
      fresh: seat.isFresh,
    });
    setText(this.who, text);
    this.who.title = text; // in case it does not fit
    const canTake =
      mayDrive(session) && seat.state.is !== "waiting" && connection.status === "open";
    this.takeButton.hidden = !canTake || seat.isHeld;
    const take = session?.driver === "other" ? "Take the seat from them" : "Take the seat";
    setText(this.takeButton, take);
    this.leaveButton.hidden = !seat.isHeld;
    const free = !seat.isHeld;
    this.phoneButton.disabled = free || !this.has("rotation");
    this.xrButton.disabled = free || !this.has("rotation");
    this.zeroButton.disabled = free;
    this.speakButton.disabled = free || !this.has("text");
    this.pad.classList.toggle("disabled", free || !this.has("stick"));
  }
}
