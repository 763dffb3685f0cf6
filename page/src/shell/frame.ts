// SPDX-License-Identifier: Apache-2.0
import type { Place } from "./layout";
import { button, h } from "./h";
import { panelKinds, type Panel, type PanelHost } from "./panel";

export type Direction = "left" | "right" | "up" | "down";

/** A person's actions on a whole panel. */
export interface FrameActions {
  move(direction: Direction): void;
  /** Enlarges the panel in its column, or in the page if it is alone there. */
  grow(factor: number): void;
  enlarge(): void;
  close(): void;
  /** Drags the panel by its bar. */
  drag(event: PointerEvent): void;
}

/** A panel with its bar: title, tools, menu. */
export class Frame {
  readonly element: HTMLElement;
  private readonly title = h("h2");
  private readonly tools = h("div.tools");
  private readonly menuButton: HTMLButtonElement;
  private readonly panel: Panel;

  constructor(
    readonly place: Place,
    host: Omit<PanelHost, "setTitle" | "tools">,
    private readonly actions: FrameActions,
  ) {
    const menu = this.menu();
    this.menuButton = button("⋮", () => this.toggle(menu), {
      class: "icon",
      "aria-haspopup": "true",
      "aria-expanded": "false",
      title: "Move, resize; with Alt and an arrow key: move",
      onkeydown: (event) => this.key(event),
    });
    const bar = h("header.panel-bar", { onpointerdown: (event) => this.grab(event) }, [
      this.title,
      this.tools,
      this.menuButton,
      button("✕", () => actions.close(), { class: "icon", title: "Close" }),
      menu,
    ]);
    const body = h("div.panel-body.stack");
    this.element = h("section", { class: `panel stack box kind-${place.args.kind}` }, [bar, body]);
    this.setTitle(place.args.kind);
    const kind = panelKinds[place.args.kind];
    this.panel = kind?.(place.args, {
      ...host,
      setTitle: (t) => this.setTitle(t),
      tools: this.tools,
    }) ?? { element: h("p.empty.muted", `Unknown panel “${place.args.kind}”.`) };
    body.append(this.panel.element);
  }

  focus(): void {
    this.menuButton.focus();
    this.element.scrollIntoView({ block: "nearest" });
  }

  close(): void {
    this.panel.close?.();
    this.element.remove();
  }

  /** Of the panel, unless its arguments give one. */
  private setTitle(ofPanel: string): void {
    const title = this.place.args.title ?? ofPanel;
    this.title.textContent = title;
    this.element.setAttribute("aria-label", title);
    this.menuButton.setAttribute("aria-label", `${title}: move, resize`);
    this.menuButton.nextElementSibling?.setAttribute("aria-label", `Close ${title}`);
  }

  private menu(): HTMLElement {
    const item = (label: string, act: () => void) =>
      button(label, () => (this.toggle(menu, false), act()), { role: "menuitem" });
    const menu: HTMLElement = h(
      "div.menu.stack.box",
      {
        role: "menu",
        hidden: true,
        onkeydown: (event) => this.menuKey(menu, event),
        onfocusout: (event) => {
          const to = event.relatedTarget;
          if (!(to instanceof Node && (menu.contains(to) || to === this.menuButton))) {
            this.toggle(menu, false);
          }
        },
      },
      [
        item("Enlarge or restore", () => this.actions.enlarge()),
        item("Move left", () => this.actions.move("left")),
        item("Move right", () => this.actions.move("right")),
        item("Move up", () => this.actions.move("up")),
        item("Move down", () => this.actions.move("down")),
        item("Larger", () => this.actions.grow(1.25)),
        item("Smaller", () => this.actions.grow(0.8)),
        item("Close", () => this.actions.close()),
      ],
    );
    return menu;
  }

  private toggle(menu: HTMLElement, open = menu.hidden): void {
    menu.hidden = !open;
    this.menuButton.setAttribute("aria-expanded", String(open));
    if (open) menu.querySelector("button")?.focus();
  }

  private menuKey(menu: HTMLElement, event: KeyboardEvent): void {
    const items = [...menu.querySelectorAll("button")];
    const at = items.findIndex((item) => item === document.activeElement);
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step) items[(at + step + items.length) % items.length]?.focus();
    else if (event.key === "Escape") this.menuButton.focus();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  private key(event: KeyboardEvent): void {
    const direction = { ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up", ArrowDown: "down" }[
      event.key
    ] as Direction | undefined;
    if (!direction || !event.altKey) return;
    event.preventDefault();
    this.actions.move(direction);
  }

  private grab(event: PointerEvent): void {
    const onControl =
      event.target instanceof Element && event.target.closest("button, select, input");
    if (event.button === 0 && !onControl) this.actions.drag(event);
  }
}
