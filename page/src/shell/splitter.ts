// SPDX-License-Identifier: Apache-2.0
import { h } from "./h";

/** Two neighbours with relative shares of the room. */
export interface Neighbours {
  readonly first: { share: number };
  readonly second: { share: number };
  /** Applies the shares to the screen. */
  apply(): void;
  /** Called when the person is done. */
  done(): void;
}

const least = 0.1; // part of their common room

/** The bar between two columns ("vertical") or panels ("horizontal"), for pointer and arrow keys. */
export function splitter(
  orientation: "vertical" | "horizontal",
  label: string,
  neighbours: Neighbours,
): HTMLElement {
  const { first, second } = neighbours;
  const set = (part: number) => {
    const sum = first.share + second.share;
    first.share = sum * Math.min(1 - least, Math.max(least, part));
    second.share = sum - first.share;
    element.setAttribute("aria-valuenow", String(Math.round((100 * first.share) / sum)));
    neighbours.apply();
  };
  const part = () => first.share / (first.share + second.share);
  const [less, more] =
    orientation === "vertical" ? ["ArrowLeft", "ArrowRight"] : ["ArrowUp", "ArrowDown"];
  const element = h("div", {
    class: `splitter ${orientation}`,
    role: "separator",
    tabindex: 0,
    "aria-orientation": orientation,
    "aria-label": label,
    "aria-valuemin": 10,
    "aria-valuemax": 90,
    "aria-valuenow": Math.round(100 * part()),
    onkeydown: (event) => {
      if (event.key !== less && event.key !== more) return;
      event.preventDefault();
      set(part() + (event.key === more ? 0.05 : -0.05));
      neighbours.done();
    },
    ondblclick: () => {
      set(0.5);
      neighbours.done();
    },
    onpointerdown: (event) => {
      const before = element.previousElementSibling?.getBoundingClientRect();
      const after = element.nextElementSibling?.getBoundingClientRect();
      if (!before || !after) return;
      event.preventDefault();
      element.setPointerCapture(event.pointerId);
      const [from, to] =
        orientation === "vertical" ? [before.left, after.right] : [before.top, after.bottom];
      element.onpointermove = (move) => {
        const at = orientation === "vertical" ? move.clientX : move.clientY;
        set((at - from) / (to - from));
      };
      element.onlostpointercapture = () => {
        element.onpointermove = null;
        neighbours.done();
      };
    },
  });
  return element;
}
