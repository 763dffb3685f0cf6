// SPDX-License-Identifier: Apache-2.0
// A stick with several inputs: pointer, keys, gamepad.

/** Left and down, -1 … 1. */
export interface Push {
  readonly left: number;
  readonly down: number;
}

export const middle: Push = { left: 0, down: 0 };

const clip = (value: number): number => Math.max(-1, Math.min(1, value));

/** The sum of all inputs, limited to full deflection. */
export class Stick {
  private readonly pushes = new Map<string, Push>();

  set(hand: string, push: Push): void {
    if (push.left === 0 && push.down === 0) this.pushes.delete(hand);
    else this.pushes.set(hand, push);
  }

  get push(): Push {
    const all = [...this.pushes.values()];
    return {
      left: clip(all.reduce((sum, { left }) => sum + left, 0)),
      down: clip(all.reduce((sum, { down }) => sum + down, 0)),
    };
  }

  release(): void {
    this.pushes.clear();
  }
}

/** Directions of keys, by position on the keyboard. */
const keys: Record<string, Push> = {
  ArrowLeft: { left: 1, down: 0 },
  ArrowRight: { left: -1, down: 0 },
  ArrowUp: { left: 0, down: -1 },
  ArrowDown: { left: 0, down: 1 },
  KeyA: { left: 1, down: 0 },
  KeyD: { left: -1, down: 0 },
  KeyW: { left: 0, down: -1 },
  KeyS: { left: 0, down: 1 },
};

/** Deflection by keys with Shift. */
const slow = 0.3;

/** The deflection by pressed keys. */
export class Keys {
  private readonly down = new Set<string>();

  /** Returns whether the key steers. */
  press(code: string): boolean {
    if (!keys[code]) return false;
    this.down.add(code);
    return true;
  }

  release(code: string): boolean {
    return this.down.delete(code);
  }

  releaseAll(): void {
    this.down.clear();
  }

  push(shift: boolean): Push {
    const scale = shift ? slow : 1;
    let { left, down } = middle;
    for (const code of this.down) {
      left += keys[code]!.left;
      down += keys[code]!.down;
    }
    return { left: clip(left) * scale, down: clip(down) * scale };
  }
}

/** A stick's axis without its dead zone: rescaled from 0 at its edge to 1. */
export function withoutDeadZone(value: number, deadZone = 0.1): number {
  const size = Math.abs(value);
  if (!(size > deadZone)) return 0; // true for NaN, too
  return (Math.sign(value) * Math.min(1, size - deadZone)) / (1 - deadZone);
}

/** The deflection of gamepads' sticks: for each axis the largest. */
export function pushOfGamepads(
  pads: readonly (Pick<Gamepad, "axes" | "connected"> | null)[],
): Push {
  const axes = pads.flatMap((pad) =>
    pad?.connected
      ? [0, 2].map((i) => [
          withoutDeadZone(pad.axes[i] ?? 0),
          withoutDeadZone(pad.axes[i + 1] ?? 0),
        ])
      : [],
  );
  const farthest = (i: number): number =>
    axes.reduce((most, axis) => (Math.abs(axis[i]!) > Math.abs(most) ? axis[i]! : most), 0);
  return { left: clip(-farthest(0)) + 0, down: clip(farthest(1)) + 0 };
}
