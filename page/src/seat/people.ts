// SPDX-License-Identifier: Apache-2.0
// The people seen, as a list of buttons, and a small form that names one of them or holds on to them.
import { isName, type People, type Person } from "../people";
import { moduleOf, type DriveOutput, type Server } from "../server";
import { button, h, setText } from "../shell";
import type { Seat } from "./holder";

const needsSeat = "Take the seat first, then name a person.";
/** How long the log is about a name that was sent: `faces` waits ten seconds until it is sure [ms]. */
const answerTime = 12_000;
/** A person who has not been seen for longer is held no more [ms]. */
const lostTime = 3000;

export class SeatPeople {
  private readonly none = h("p.muted.small");
  private readonly caption = h("span.muted.small", "People seen:");
  readonly list = h("div.seat-people.wrap", { role: "group", "aria-label": "People seen" }, [
    this.none,
    this.caption,
  ]);
  private readonly buttons = new Map<number, HTMLButtonElement>(); // by track
  private readonly who = h("b.person-who");
  private readonly name = h("input", {
    type: "text",
    id: "person-name",
    maxlength: 64,
    autocomplete: "off",
  });
  private readonly learn = h("button", { type: "submit" }, "Learn");
  private readonly hold = button("Hold", () => this.toggleHold(), {
    type: "button",
    title: "Look at this person until you release them",
    "aria-pressed": "false",
  });
  readonly form = h(
    "form.person-form.wrap",
    {
      hidden: true,
      "aria-label": "Person",
      onsubmit: (event: SubmitEvent) => {
        event.preventDefault();
        this.sendName();
      },
      onkeydown: (event: KeyboardEvent) => event.key === "Escape" && this.shut(),
    },
    [
      this.who,
      h("span.row", [h("label", { for: "person-name" }, "Name:"), this.name, this.learn]),
      this.hold,
      button("×", () => this.shut(), { type: "button", class: "icon", "aria-label": "Close" }),
    ],
  );
  /** The person of the form; 0: it is closed. */
  private track = 0;
  private key = "";
  private sentName = -Infinity; // by performance.now() [ms]
  private seenHeld = 0; // the same
  private readonly ends: (() => void)[];

  /** @param has  whether an output of the page is linked. */
  constructor(
    private readonly server: Server,
    private readonly seat: Seat,
    private readonly people: People,
    private readonly has: (output: DriveOutput) => boolean,
    private readonly say: (sentence: string) => void,
  ) {
    this.ends = [
      people.onChange(() => this.update()),
      seat.onHeld(() => this.update()),
      server.onLog(({ module, text }) => {
        const isAnswer = performance.now() - this.sentName < answerTime;
        if (isAnswer && this.namers().includes(module)) say(`${module}: ${text}`);
      }),
    ];
  }

  close(): void {
    for (const end of this.ends) end();
  }

  /** A person in the image was clicked: opens the form, or releases them. */
  click(person: Person): void {
    if (!this.seat.isHeld) return this.say(needsSeat);
    if (this.seat.held === person.track) return this.release();
    this.open(person);
  }

  update(): void {
    const seen = this.people.seen().sort((a, b) => a.track - b.track);
    const { held } = this.seat;
    this.letGo(seen);
    this.list.hidden = !this.people.findsFaces;
    const { finder, isLate } = this.people;
    setText(
      this.none,
      isLate ? `${finder} is late: no faces for some seconds.` : "No face is seen.",
    );
    const shown = seen.map(({ track, name, reason }) => ({ track, name, reason }));
    const key = JSON.stringify([shown, held, this.seat.isHeld, this.track]);
    if (key !== this.key) this.draw(seen);
    this.key = key;
    const person = seen.find(({ track }) => track === this.track);
    if (person) setText(this.who, person.name);
    this.learn.disabled = !this.seat.isHeld || !this.has("name");
    this.hold.disabled = !this.seat.isHeld || !this.has("hold");
    this.hold.setAttribute("aria-pressed", String(held !== 0 && held === this.track));
  }

  /** Changes the buttons in place, so that they can be pressed and keep the focus. */
  private draw(seen: readonly Person[]): void {
    for (const [track, each] of this.buttons)
      if (!seen.some((person) => person.track === track)) {
        each.remove();
        this.buttons.delete(track);
      }
    for (const person of seen) {
      const { name, track, reason } = person;
      const each = this.buttons.get(track) ?? this.addButton(track);
      const words = [name === "?" ? `? ${track}` : name, reason].filter(Boolean).join(" · ");
      setText(each, words);
      each.classList.toggle("attended", reason !== "");
      each.disabled = !this.seat.isHeld;
      each.setAttribute("aria-expanded", String(this.track === track));
    }
    this.none.hidden = seen.length > 0;
    this.caption.hidden = seen.length === 0;
  }

  private addButton(track: number): HTMLButtonElement {
    const press = (): void => {
      const person = this.people.seen().find((each) => each.track === track);
      if (person && this.seat.held === track) this.release();
      else if (this.track === track) this.shut();
      else if (person) this.open(person);
    };
    const title = "Name this person, or hold on to them";
    const added = button("", press, { type: "button", "data-track": track, title });
    this.buttons.set(track, added);
    this.list.append(added); // tracks are numbered as they appear
    return added;
  }

  private open({ track, name, person }: Person): void {
    this.track = track;
    this.name.value = person > 0 && name !== `person ${person}` ? name : "";
    setText(this.who, name);
    this.form.hidden = false;
    this.update();
    this.name.focus();
    this.name.select();
  }

  private shut(): void {
    const track = this.track;
    this.track = 0;
    const isInside = this.form.contains(document.activeElement);
    this.form.hidden = true;
    this.update();
    if (isInside) this.list.querySelector<HTMLElement>(`[data-track="${track}"]`)?.focus();
  }

  private sendName(): void {
    const name = this.name.value.trim();
    if (!this.seat.isHeld) return this.say(needsSeat);
    if (!this.has("name")) return;
    if (name === "") return this.say("Type a name.");
    if (!isName(name))
      return this.say("This name is too long, begins with a dot, or has a “/” or a tab in it.");
    if (!this.seat.name(this.track, name)) return;
    this.sentName = performance.now();
    this.say(`Asked to learn this person as ${name}.`);
    this.shut();
  }

  private toggleHold(): void {
    if (this.seat.held === this.track) return this.release();
    this.seenHeld = performance.now();
    if (this.seat.hold(this.track)) this.say("Asked to look at this person.");
  }

  private release(): void {
    this.seat.hold(0);
    this.say("Nobody is held any more.");
  }

  /** Ends the hold on a person who has left. */
  private letGo(seen: readonly Person[]): void {
    const { held } = this.seat;
    if (held === 0) return;
    const now = performance.now();
    if (seen.some(({ track }) => track === held)) this.seenHeld = now;
    else if (now - this.seenHeld > lostTime) this.seat.hold(0);
  }

  /** The modules that learn names. */
  private namers(): string[] {
    const { state, session } = this.server;
    const links = state?.links.filter(({ from }) => from === `${session?.web}.name`) ?? [];
    return links.map(({ to }) => moduleOf(to));
  }
}
