// SPDX-License-Identifier: Apache-2.0
// Draws people and hands over an image.
import { setText, svg } from "../shell/h";
import type { Person, Sighting } from "./people";
import type { Hand, Point } from "./tables";

/** The joints of a hand that bones connect: each finger, and the palm. */
const bones = [
  [0, 1, 2, 3, 4],
  [5, 6, 7, 8],
  [9, 10, 11, 12],
  [13, 14, 15, 16],
  [17, 18, 19, 20],
  [0, 5, 9, 13, 17, 0],
];

const line = (points: readonly Point[]): string =>
  points.map(({ x, y }, i) => `${i === 0 ? "M" : "L"}${x} ${y}`).join("");
const dots = (points: readonly Point[]): string =>
  points.map(({ x, y }) => `M${x} ${y}h0`).join("");

/** Lines, points and a text over an image, each line and point on a dark edge. */
class Mark {
  private readonly lines = [svg("path.edge"), svg("path.ink")];
  private readonly dots = [svg("path.edge"), svg("path.ink")];
  private readonly text = svg("text", { dy: "-0.4em" });
  readonly element: SVGGElement;

  constructor(name: string, track: number) {
    this.lines.forEach((path) => path.classList.add("seen-lines"));
    this.dots.forEach((path) => path.classList.add("seen-dots"));
    const parts = [...this.lines, ...this.dots, this.text];
    this.element = svg("g", { class: name, "data-track": track }, parts);
  }

  show(lines: string, points: readonly Point[], text: string, at: Point): void {
    for (const path of this.lines) path.setAttribute("d", lines);
    for (const path of this.dots) path.setAttribute("d", dots(points));
    setText(this.text, text);
    this.text.setAttribute("x", String(at.x));
    this.text.setAttribute("y", String(at.y));
  }
}

function showPerson(mark: Mark, person: Person): void {
  const { x, y, width, height, points, name, reason } = person;
  const box = `M${x} ${y}h${width}v${height}h${-width}z`;
  mark.show(box, points, reason ? `${name} · ${reason}` : name, { x, y });
  mark.element.classList.toggle("attended", reason !== "");
}

function showHand(mark: Mark, { points, sign }: Hand): void {
  const lines = bones.map((joints) => line(joints.map((i) => points[i]!))).join("");
  const top = points.reduce((a, b) => (b.y < a.y ? b : a));
  mark.show(lines, points, sign, top);
}

/** People and hands, over an image of a sensor. The list of people says the same in words. */
export class PeopleLayer {
  readonly element = svg("svg.people-layer", { "aria-hidden": "true" });
  private readonly marks = new Map<string, Mark>();
  private people: readonly Person[] = [];
  private size = { width: 0, height: 0 };

  /** @param size  of the sensor [px]. */
  show({ people, hands }: Sighting, size: { width: number; height: number }): void {
    this.people = people;
    this.size = size;
    const former = new Set(this.marks.keys());
    if (former.size + people.length + hands.length === 0) return;
    // The origin is the centre of the first pixel.
    this.element.setAttribute("viewBox", `-0.5 -0.5 ${size.width} ${size.height}`);
    this.element.style.setProperty("--px", String(1 / this.scale().scale));
    const mark = (name: string, track: number): Mark => {
      const key = `${name} ${track}`;
      former.delete(key);
      const mark = this.marks.get(key) ?? new Mark(name, track);
      this.marks.set(key, mark);
      if (!mark.element.isConnected) this.element.append(mark.element);
      return mark;
    };
    for (const person of people) showPerson(mark("seen-person", person.track), person);
    for (const hand of hands) showHand(mark("seen-hand", hand.track), hand);
    for (const key of former) {
      this.marks.get(key)?.element.remove();
      this.marks.delete(key);
    }
  }

  /** The person at a point of the window. */
  personAt(clientX: number, clientY: number): Person | undefined {
    if (this.element.hasAttribute("hidden")) return undefined;
    const { scale, left, top } = this.scale();
    const [x, y] = [(clientX - left) / scale - 0.5, (clientY - top) / scale - 0.5];
    return this.people.find(
      (each) => x >= each.x && x < each.x + each.width && y >= each.y && y < each.y + each.height,
    );
  }

  /** Size of a pixel of the sensor, and the corner of the image, in the window [px]. */
  private scale(): { scale: number; left: number; top: number } {
    const box = this.element.getBoundingClientRect();
    const { width, height } = this.size;
    const scale = Math.min(box.width / width, box.height / height) || 1;
    return {
      scale,
      left: box.left + (box.width - width * scale) / 2,
      top: box.top + (box.height - height * scale) / 2,
    };
  }
}
