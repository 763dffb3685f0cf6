// SPDX-License-Identifier: Apache-2.0
// A pose or a rotation as two dials: pan from above, tilt from the side.
import type { Arrival } from "../server";
import { h, setText, svg } from "../shell/h";
import { Pace } from "../shell/pace";
import { angleText, placeText, poseOf, type Pose } from "./pose";
import type { View, ViewKind } from "./view";

const radius = 50; // of a dial
const readingPeriod = 200; // [ms], so that numbers can be read

/** A dial whose arrow turns clockwise from its zero. */
class Dial {
  private readonly sector = svg("path.dial-sector");
  private readonly pointer: SVGGElement;
  private readonly value = h("strong.dial-value");
  readonly element: HTMLElement;

  /** @param zero  where its arrow points at 0, clockwise from the right [°]. */
  constructor(
    name: string,
    private readonly zero: number,
    head: SVGElement,
  ) {
    const tick = (angle: number) =>
      svg("line.dial-tick", {
        x1: angle % 90 === 0 ? radius - 8 : radius - 4,
        x2: radius,
        transform: `rotate(${angle})`,
      });
    this.pointer = svg("g", [
      head,
      svg("line.dial-shaft", { x1: 20, x2: radius - 13 }),
      svg("path.dial-head", { d: `M${radius - 15} -7L${radius - 1} 0L${radius - 15} 7z` }),
    ]);
    this.element = h("figure.dial", [
      svg("svg", { viewBox: "-54 -54 108 108", "aria-hidden": "true" }, [
        svg("circle.dial-rim", { r: radius }),
        this.sector,
        svg(
          "g",
          Array.from({ length: 12 }, (_, i) => tick(30 * i)),
        ),
        svg("line.dial-zero", { x2: radius, transform: `rotate(${zero})` }),
        this.pointer,
      ]),
      h("figcaption", [h("span.muted.small", name), this.value]),
    ]);
  }

  /** @param angle  clockwise [°]. */
  turn(angle: number): void {
    this.pointer.setAttribute("transform", `rotate(${this.zero + angle})`);
    const at = (degrees: number) => {
      const turn = ((this.zero + degrees) * Math.PI) / 180;
      return `${((radius - 9) * Math.cos(turn)).toFixed(2)} ${((radius - 9) * Math.sin(turn)).toFixed(2)}`;
    };
    const flags = `${Math.abs(angle) > 180 ? 1 : 0} ${angle > 0 ? 1 : 0}`;
    this.sector.setAttribute(
      "d",
      `M0 0L${at(0)}A${radius - 9} ${radius - 9} 0 ${flags} ${at(angle)}z`,
    );
  }

  read(text: string): void {
    setText(this.value, text);
  }
}

/** A head from above, which looks to the right of the drawing. */
const headFromAbove = () =>
  svg("g.dial-body", [
    svg("path", { d: "M-14 0A13 14 0 0 1 11 -6Q17 -4 17 0Q17 4 11 6A13 14 0 0 1 -14 0z" }),
    svg("circle.dial-eye", { cx: 7, cy: -6, r: 2.4 }),
    svg("circle.dial-eye", { cx: 7, cy: 6, r: 2.4 }),
  ]);

/** A head from its right side, which looks to the right of the drawing. */
const headFromTheSide = () =>
  svg("g.dial-body", [
    svg("path", { d: "M-5 18V11A14 14 0 1 1 12 -7L17 2L12 4Q13 13 5 13V18z" }),
    svg("circle.dial-eye", { cx: 6, cy: -4, r: 2.4 }),
  ]);

export class PoseView implements View {
  private readonly pan = new Dial("pan, from above", -90, headFromAbove());
  private readonly tilt = new Dial("tilt, from the side", 0, headFromTheSide());
  private readonly more = h("p.pose-more.muted");
  readonly element = h("div.pose-view.stack", [
    h("div.dials", [this.pan.element, this.tilt.element]),
    this.more,
  ]);
  private readonly pace = new Pace(readingPeriod);

  async show({ message }: Arrival): Promise<void> {
    const pose = poseOf(message);
    if (!pose) return;
    this.pan.turn(-pose.pan);
    this.tilt.turn(pose.tilt);
    this.pace.run(() => this.read(pose));
    await new Promise(requestAnimationFrame);
  }

  close(): void {
    this.pace.close();
  }

  private read(pose: Pose): void {
    this.pan.read(angleText(pose.pan, "left", "right"));
    this.tilt.read(angleText(pose.tilt, "down", "up"));
    const roll = angleText(pose.roll, "right", "left");
    const place = pose.place ? placeText(pose.place) : "";
    const rolled = roll === "0.0°" ? "" : `rolled ${roll}`;
    setText(this.more, [place, rolled].filter(Boolean).join("; "));
  }
}

export const poseView: ViewKind = {
  name: "dials",
  fits: ({ type, width, height, components }) =>
    type === "transformation"
      ? width === 4 && height === 4
      : type === "rotation" && width * height === 1 && components >= 3,
  make: () => new PoseView(),
};
