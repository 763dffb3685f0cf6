// SPDX-License-Identifier: Apache-2.0
// Inputs for the stick: pointers on a pad and on the image, keys, gamepads.
import { Keys, middle, pushOfGamepads, type Push, type Stick } from "./steering";

/** A press that moves less than this is a click [px]. */
const clickRadius = 6;

/**
 * Steers by dragging on an element; the speed grows with the distance from the press.
 *
 * @param reach  distance of a full deflection for the element's size [px].
 * @param shown  called with each push, to draw it.
 * @param clicked  called for a press without motion.
 */
export function dragSteers(
  element: HTMLElement,
  stick: Stick,
  hand: string,
  reach: () => number,
  shown: (push: Push) => void,
  clicked: (event: PointerEvent) => void = () => {},
): void {
  let start: { id: number; x: number; y: number; moved: boolean } | undefined;
  const end = (): void => {
    start = undefined;
    stick.set(hand, middle);
    shown(middle);
  };
  element.addEventListener("pointerdown", (event) => {
    if (start || event.button !== 0) return;
    start = { id: event.pointerId, x: event.clientX, y: event.clientY, moved: false };
    element.setPointerCapture(event.pointerId);
  });
  element.addEventListener("pointermove", (event) => {
    if (event.pointerId !== start?.id) return;
    const dx = event.clientX - start.x;
    const dy = event.clientY - start.y;
    start.moved ||= Math.hypot(dx, dy) > clickRadius;
    if (!start.moved) return;
    const clip = (value: number): number => Math.max(-1, Math.min(1, value));
    const push = { left: clip(-dx / reach()), down: clip(dy / reach()) };
    stick.set(hand, push);
    shown(push);
  });
  element.addEventListener("pointerup", (event) => {
    if (event.pointerId !== start?.id) return;
    const { moved } = start;
    end();
    if (!moved) clicked(event);
  });
  for (const name of ["pointercancel", "lostpointercapture"] as const) {
    element.addEventListener(name, (event) => event.pointerId === start?.id && end());
  }
}

/** Steers by arrow keys and WASD while an element or a descendant has the focus. */
export function keysSteer(element: HTMLElement, stick: Stick): void {
  const keys = new Keys();
  const isText = (target: EventTarget | null): boolean =>
    target instanceof HTMLElement && target.matches("input, select, textarea");
  element.addEventListener("keydown", (event) => {
    if (isText(event.target) || event.ctrlKey || event.metaKey || event.altKey) return;
    if (keys.press(event.code)) event.preventDefault();
    stick.set("keys", keys.push(event.shiftKey));
  });
  element.addEventListener("keyup", (event) => {
    keys.release(event.code);
    stick.set("keys", keys.push(event.shiftKey));
  });
  const releaseAll = (): void => {
    keys.releaseAll();
    stick.set("keys", middle);
  };
  element.addEventListener("focusout", (event) => {
    if (!element.contains(event.relatedTarget as Node | null)) releaseAll();
  });
  window.addEventListener("blur", releaseAll);
}

/** Steers by gamepads; returns a function that ends it. */
export function gamepadsSteer(stick: Stick): () => void {
  const timer = setInterval(
    () => stick.set("gamepad", pushOfGamepads(navigator.getGamepads())),
    33,
  );
  return () => clearInterval(timer);
}
