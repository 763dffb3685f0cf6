// SPDX-License-Identifier: Apache-2.0
import { h } from "../shell/h";

/** A position in an image, as fractions of its width and height, 0 … 1. */
export interface Spot {
  readonly across: number;
  readonly down: number;
}

/** Sensor pixel at a spot; 0 is the centre of the first pixel (R44). */
export function pixelAt(spot: Spot, width: number, height: number): { x: number; y: number } {
  return { x: spot.across * width - 0.5, y: spot.down * height - 0.5 };
}

/** Position of a pointer in a canvas with `object-fit: contain`; undefined: outside. */
export function spotOf(canvas: HTMLCanvasElement, x: number, y: number): Spot | undefined {
  const box = canvas.getBoundingClientRect();
  const scale = Math.min(box.width / canvas.width, box.height / canvas.height);
  const left = box.left + (box.width - canvas.width * scale) / 2;
  const top = box.top + (box.height - canvas.height * scale) / 2;
  const across = (x - left) / (canvas.width * scale);
  const down = (y - top) / (canvas.height * scale);
  return across >= 0 && across < 1 && down >= 0 && down < 1 ? { across, down } : undefined;
}

/**
 * Shows the value of a canvas under the pointer, or at a spot moved with the arrow keys.
 *
 * @param read  text for a spot.
 */
export class Probe {
  readonly output = h("output.probe.mono");
  private spot?: Spot;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly read: (spot: Spot) => string,
  ) {
    canvas.tabIndex = 0;
    canvas.addEventListener("pointermove", (event) => {
      this.spot = spotOf(canvas, event.clientX, event.clientY);
      this.update();
    });
    canvas.addEventListener("pointerleave", () => {
      this.spot = undefined;
      this.update();
    });
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  /** Reads again, after the image has changed. */
  update(): void {
    this.output.textContent = this.spot ? this.read(this.spot) : "";
  }

  private key(event: KeyboardEvent): void {
    const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const step = steps[event.key as keyof typeof steps];
    if (!step) return;
    event.preventDefault();
    const size = event.shiftKey ? 10 : 1;
    const { across, down } = this.spot ?? { across: 0.5, down: 0.5 };
    const inside = (part: number) => Math.min(0.9999, Math.max(0, part));
    this.spot = {
      across: inside(across + (step[0]! * size) / this.canvas.width),
      down: inside(down + (step[1]! * size) / this.canvas.height),
    };
    this.update();
  }
}
