// SPDX-License-Identifier: Apache-2.0

type Child = Node | string | number | null | undefined | false;
/** A child, or several; null, undefined and false are skipped. */
export type Children = Child | readonly (Child | readonly Child[])[];

type Handlers = {
  [K in keyof HTMLElementEventMap as `on${K}`]?: (event: HTMLElementEventMap[K]) => void;
};
type Attributes = Handlers & { [name: string]: unknown };
type Parts = readonly (Attributes | Children)[];

/**
 * Makes an element: h("button.small", { onclick: stop, "aria-label": "Stop" }, "Stop"), from its tag
 * with classes, optional attributes, and children. Functions become listeners, true an empty
 * attribute; false, null and undefined are skipped.
 */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K | `${K}.${string}`,
  ...parts: Parts
): HTMLElementTagNameMap[K] {
  const [name = "", ...classes] = tag.split(".");
  return complete(document.createElement(name as K), classes, parts);
}

/** As h(), for SVG. */
export function svg<K extends keyof SVGElementTagNameMap>(
  tag: K | `${K}.${string}`,
  ...parts: Parts
): SVGElementTagNameMap[K] {
  const [name = "", ...classes] = tag.split(".");
  const element = document.createElementNS("http://www.w3.org/2000/svg", name as K);
  return complete(element, classes, parts);
}

/** A button with an action. */
export function button(
  text: Children,
  onclick: (event: MouseEvent) => void,
  attributes: Attributes = {},
): HTMLButtonElement {
  return h("button", { ...attributes, onclick }, text);
}

/** A dialog with a class, which a click beside it closes. */
export function dialogBox(name: string, label: string, content: HTMLElement): HTMLDialogElement {
  const close = ({ target }: Event) => target === dialog && dialog.close();
  const attributes = { class: `${name} box`, "aria-label": label, onclick: close };
  const dialog: HTMLDialogElement = h("dialog", attributes, content);
  return dialog;
}

/** An arrow head as a marker of a size [px]; `refX`: where its line ends. */
export function arrowHead(id: string, size: number, attributes: Attributes): SVGDefsElement {
  const middle = size / 2;
  const box = { id, viewBox: `0 0 ${size} ${size}`, refY: middle, ...attributes };
  const shape = svg("path.arrow", { d: `M0 0L${size} ${middle}L0 ${size}z` });
  return svg("defs", svg("marker", box, shape));
}

/** Replaces the children of an element. */
export function fill(element: Element, ...children: readonly Children[]): void {
  const shown = children
    .flat(2)
    .filter((child) => child !== null && child !== undefined && child !== false);
  element.replaceChildren(...(shown as (Node | string)[]));
}

/** Sets a text only if it differs, to avoid needless drawing and reading aloud. */
export function setText(element: Element, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

/** The size of an element's text [px]. */
export function emOf(element: Element): number {
  return parseFloat(getComputedStyle(element).fontSize) || 16;
}

function complete<E extends Element>(element: E, classes: readonly string[], parts: Parts): E {
  if (classes.length > 0) element.setAttribute("class", classes.join(" "));
  const [first, ...others] = parts;
  const [attributes, children] = isAttributes(first) ? [first, others] : [{}, parts];
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") {
      element.addEventListener(name.slice(2), value as EventListener);
    } else if (value !== false && value !== null && value !== undefined) {
      element.setAttribute(name, value === true ? "" : String(value));
    }
  }
  fill(element, ...(children as Children[]));
  return element;
}

function isAttributes(part: Attributes | Children): part is Attributes {
  return (
    typeof part === "object" && part !== null && !(part instanceof Node) && !Array.isArray(part)
  );
}
