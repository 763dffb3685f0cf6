// SPDX-License-Identifier: Apache-2.0
// The panels on the page: columns of frames, which can be moved and resized.
import { Frame, type Direction } from "./frame";
import { emOf, h } from "./h";
import { sameArgs, type Column, type Layout, type Place } from "./layout";
import type { PanelArgs, PanelHost } from "./panel";
import { splitter } from "./splitter";

/** Least width of a column [em]. */
const narrowest = 32;

export interface BoardHost extends Pick<PanelHost, "server" | "say" | "openPanel"> {
  /** A person or a panel has changed the layout. */
  changed(): void;
}

/** The drop target of a dragged panel: a side of a panel. */
interface Target {
  readonly place: Place;
  readonly side: Direction;
}

/** Insets of the half of a panel at each side. */
const halves = { left: "0 50% 0 0", right: "0 0 0 50%", up: "0 0 50%", down: "50% 0 0" };

export class Board {
  readonly element = h("main.board", { id: "main", tabindex: -1 });
  private layout: Layout = [];
  private readonly frames = new Map<Place, Frame>();

  constructor(private readonly host: BoardHost) {}

  get current(): Layout {
    return this.layout;
  }

  /** Shows a layout; panels shared with the previous one continue. */
  show(layout: Layout): void {
    const former = [...this.frames.keys()];
    for (const column of layout) {
      column.places = column.places.map((place) => {
        const at = former.findIndex((each) => sameArgs(each.args, place.args));
        if (at < 0) return place;
        const [kept] = former.splice(at, 1);
        kept!.share = place.share;
        return kept!;
      });
    }
    for (const place of former) this.drop(place);
    this.layout = layout;
    this.render();
  }

  /** Opens a panel in the column with the most room, or goes to the open one. */
  open(args: PanelArgs): void {
    const there = [...this.frames.keys()].find((place) => sameArgs(place.args, args));
    if (there) return this.frames.get(there)?.focus();
    const place: Place = { args, share: 1 };
    const width = this.element.clientWidth / emOf(this.element);
    const wide = Math.max(1, Math.floor(width / narrowest));
    if (this.layout.length < wide) this.layout.push({ share: 1, places: [place] });
    else this.roomiest().places.push(place);
    this.finish(place);
  }

  /** The column whose panels have the most room each; of several the last. */
  private roomiest(): Column {
    const room = (column: Column) => column.share / (column.places.length + 1);
    return this.layout.reduceRight((best, column) => (room(column) > room(best) ? column : best));
  }

  private columnOf(place: Place): Column {
    return this.layout.find((column) => column.places.includes(place))!;
  }

  private drop(place: Place): void {
    this.frames.get(place)?.close();
    this.frames.delete(place);
  }

  private close(place: Place): void {
    this.take(place);
    this.drop(place);
    this.finish();
    this.element.focus();
  }

  /** Removes a panel from its column, and an empty column. */
  private take(place: Place): void {
    const column = this.columnOf(place);
    column.places.splice(column.places.indexOf(place), 1);
    if (column.places.length === 0) this.layout.splice(this.layout.indexOf(column), 1);
  }

  private move(place: Place, direction: Direction): void {
    const column = this.columnOf(place);
    const index = this.layout.indexOf(column);
    if (direction === "up" || direction === "down") {
      const at = column.places.indexOf(place);
      const to = at + (direction === "up" ? -1 : 1);
      if (to < 0 || to >= column.places.length) return;
      column.places.splice(at, 1);
      column.places.splice(to, 0, place);
    } else {
      const step = direction === "left" ? -1 : 1;
      const neighbour = this.layout[index + step];
      if (!neighbour && column.places.length === 1) return;
      this.take(place);
      if (neighbour) neighbour.places.push(place);
      else this.layout.splice(step < 0 ? 0 : this.layout.length, 0, { share: 1, places: [place] });
    }
    this.finish(place);
  }

  private put(place: Place, { place: other, side }: Target): void {
    if (place === other) return;
    this.take(place);
    const column = this.columnOf(other);
    if (side === "up" || side === "down") {
      column.places.splice(column.places.indexOf(other) + (side === "down" ? 1 : 0), 0, place);
    } else {
      const index = this.layout.indexOf(column) + (side === "right" ? 1 : 0);
      this.layout.splice(index, 0, { share: column.share, places: [place] });
    }
    this.finish(place);
  }

  private grow(place: Place, factor: number): void {
    const column = this.columnOf(place);
    const isAlone = column.places.length === 1 && !this.isNarrow;
    const what = isAlone ? column : place;
    what.share = Math.min(10, Math.max(0.1, what.share * factor));
    this.finish(place);
  }

  private enlarge(place: Place): void {
    const frame = this.frames.get(place)!;
    const isLarge = frame.element.classList.toggle("enlarged");
    this.element.classList.toggle("has-enlarged", isLarge);
    frame.focus();
  }

  private drag(place: Place, down: PointerEvent): void {
    const element = this.frames.get(place)!.element;
    const mark = h("div.drop-mark");
    let target: Target | undefined;
    const move = (event: PointerEvent) => {
      if (Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) < 8) return;
      element.classList.add("dragged");
      target = this.targetAt(event.clientX, event.clientY);
      if (!target) return mark.remove();
      this.frames.get(target.place)!.element.append(mark);
      mark.style.inset = halves[target.side];
    };
    const end = (event: Event) => {
      removeEventListener("pointermove", move);
      removeEventListener("pointerup", end);
      removeEventListener("pointercancel", end);
      mark.remove();
      element.classList.remove("dragged");
      if (target && event.type === "pointerup") this.put(place, target);
    };
    addEventListener("pointermove", move);
    addEventListener("pointerup", end);
    addEventListener("pointercancel", end);
  }

  private targetAt(x: number, y: number): Target | undefined {
    for (const [place, { element }] of this.frames) {
      const { left, top, width, height } = element.getBoundingClientRect();
      const across = (x - left) / width;
      const down = (y - top) / height;
      if (across < 0 || across > 1 || down < 0 || down > 1) continue;
      const distances: [Direction, number][] = [
        ["left", across],
        ["right", 1 - across],
        ["up", down],
        ["down", 1 - down],
      ];
      const [side] = distances.reduce((best, each) => (each[1] < best[1] ? each : best));
      return { place, side };
    }
    return undefined;
  }

  private get isNarrow(): boolean {
    return this.element.clientWidth < 700;
  }

  /** Shows and reports a change. */
  private finish(focus?: Place): void {
    this.render();
    this.host.changed();
    if (focus) this.frames.get(focus)?.focus();
  }

  private frameOf(place: Place): Frame {
    let frame = this.frames.get(place);
    if (!frame) {
      const host = {
        ...this.host,
        setArgs: (args: PanelArgs) => {
          if (sameArgs(place.args, args)) return;
          place.args = args;
          this.host.changed();
        },
      };
      frame = new Frame(place, host, {
        move: (direction) => this.move(place, direction),
        grow: (factor) => this.grow(place, factor),
        enlarge: () => this.enlarge(place),
        close: () => this.close(place),
        drag: (event) => this.drag(place, event),
      });
      this.frames.set(place, frame);
    }
    return frame;
  }

  private render(): void {
    const columns = this.layout.map(({ places }) =>
      h(
        "div.column.stack",
        this.split(
          places,
          places.map((place) => this.frameOf(place).element),
          "horizontal",
        ),
      ),
    );
    const parts = this.split(this.layout, columns, "vertical");
    if (parts.length === 0) {
      parts.push(h("p.empty.muted", "No panel is open. Press “Open…” to choose one."));
    }
    this.element.replaceChildren(...parts);
    const isLarge = this.element.querySelector(".enlarged") !== null;
    this.element.classList.toggle("has-enlarged", isLarge);
  }

  /** Elements with the shares of `those`, and splitters between them. */
  private split(
    those: readonly { share: number }[],
    elements: readonly HTMLElement[],
    orientation: "vertical" | "horizontal",
  ): HTMLElement[] {
    const apply = () =>
      those.forEach(({ share }, i) => elements[i]!.style.setProperty("--share", `${share}`));
    apply();
    const label = {
      horizontal: "Heights of the panels above and below",
      vertical: "Widths of the columns left and right",
    }[orientation];
    return elements.flatMap((element, i) => {
      const [first, second] = [those[i - 1], those[i]];
      if (!first || !second) return [element];
      const neighbours = { first, second, apply, done: () => this.host.changed() };
      return [splitter(orientation, label, neighbours), element];
    });
  }
}
