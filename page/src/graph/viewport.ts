// SPDX-License-Identifier: Apache-2.0
// Scrolls and zooms a drawing in its window: scroll bars, drag, Ctrl and the wheel, the keys + - 0.

/** Sizes of a drawing by themselves, relative to its own, where the page's text has 15 px. */
const scales = { least: 0.92, most: 1.5 };

/** A drawing, an SVG element with a `viewBox`, inside a window that scrolls. */
export class Viewport {
  private scale = 1;
  private width = 1; // of the drawing [px]
  private height = 1;
  /** A person has chosen the scale. */
  private isChosen = false;
  /** A corner that is in sight when it opens; undefined: it has opened. */
  private corner?: { x: number; y: number } = { x: 0, y: 0 };
  private readonly resizing: ResizeObserver;

  constructor(
    private readonly window: HTMLElement,
    private readonly drawing: SVGSVGElement,
  ) {
    window.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    window.addEventListener("pointerdown", (event) => this.drag(event));
    window.addEventListener("keydown", (event) => this.key(event));
    this.resizing = new ResizeObserver(() => !this.isChosen && this.fit());
    this.resizing.observe(window);
  }

  close(): void {
    this.resizing.disconnect();
  }

  /** Chooses a corner of the drawing that is in sight when it opens. */
  openAt(corner: { x: number; y: number }): void {
    if (this.corner) this.corner = corner;
  }

  /** Size of the drawing [px]. @param keepsScale  whether its scale stays. */
  setSize(width: number, height: number, keepsScale: boolean): void {
    this.width = Math.max(1, width);
    this.height = Math.max(1, height);
    this.drawing.setAttribute("viewBox", `0 0 ${this.width} ${this.height}`);
    if (this.isChosen || keepsScale) this.apply();
    else this.fit();
  }

  /** Fits the drawing into the window, as far as its text stays readable; else it scrolls. */
  fit(): void {
    const { clientWidth, clientHeight } = this.window;
    if (clientWidth === 0 || clientHeight === 0) return;
    const text = parseFloat(getComputedStyle(this.window).fontSize) / 15;
    const whole = Math.min((clientWidth - 1) / this.width, (clientHeight - 1) / this.height);
    this.scale = Math.min(scales.most * text, Math.max(scales.least * text, whole));
    this.isChosen = false;
    this.apply();
    if (!this.corner) return;
    const { x, y } = this.corner;
    this.window.scrollTo(x * this.scale - clientWidth, y * this.scale - clientHeight);
    this.corner = undefined;
  }

  /** Zooms about a point of the window [px], by default its centre. */
  zoom(factor: number, at?: { x: number; y: number }): void {
    const { clientWidth, clientHeight, scrollLeft, scrollTop } = this.window;
    const { x, y } = at ?? { x: clientWidth / 2, y: clientHeight / 2 };
    const scale = Math.min(4, Math.max(0.2, this.scale * factor));
    const grown = scale / this.scale;
    this.scale = scale;
    this.isChosen = true;
    this.apply();
    this.window.scrollTo((scrollLeft + x) * grown - x, (scrollTop + y) * grown - y);
  }

  /** Scrolls so that one point of the drawing is where another one was. */
  keep(before: { x: number; y: number }, now: { x: number; y: number }): void {
    this.window.scrollBy((now.x - before.x) * this.scale, (now.y - before.y) * this.scale);
  }

  private apply(): void {
    this.drawing.setAttribute("width", (this.width * this.scale).toFixed(1));
    this.drawing.setAttribute("height", (this.height * this.scale).toFixed(1));
  }

  private wheel(event: WheelEvent): void {
    if (!event.ctrlKey) return;
    event.preventDefault();
    const unit = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? 1 : 30;
    const { left, top } = this.window.getBoundingClientRect();
    const at = { x: event.clientX - left, y: event.clientY - top };
    this.zoom(Math.exp(-event.deltaY * unit * 0.0015), at);
  }

  /** Drags the drawing with the mouse; fingers scroll it. */
  private drag(down: PointerEvent): void {
    if (down.button !== 0 || down.pointerType !== "mouse") return;
    if (down.target instanceof Element && down.target.closest('[role="button"]')) return;
    const { scrollLeft, scrollTop } = this.window;
    const move = (event: PointerEvent): void =>
      this.window.scrollTo(
        scrollLeft - (event.clientX - down.clientX),
        scrollTop - (event.clientY - down.clientY),
      );
    const end = (): void => {
      removeEventListener("pointermove", move);
      removeEventListener("pointerup", end);
    };
    addEventListener("pointermove", move);
    addEventListener("pointerup", end);
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "+" || event.key === "=") this.zoom(1.25);
    else if (event.key === "-") this.zoom(0.8);
    else if (event.key === "0") this.fit();
    else return;
    event.preventDefault();
  }
}
