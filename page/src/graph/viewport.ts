// SPDX-License-Identifier: Apache-2.0
// Moves and zooms a drawing in its window: drag, wheel, pinch, and the keys + - 0 and arrows.

/** A drawing inside an SVG element; `scene` is the group that moves. */
export class Viewport {
  private scale = 1;
  private x = 0; // of the drawing's corner in the window [px]
  private y = 0;
  private width = 1; // of the drawing [px]
  private height = 1;
  private touched = false;
  private readonly pointers = new Map<number, { x: number; y: number }>();
  private readonly resizing: ResizeObserver;

  constructor(
    private readonly window: SVGSVGElement,
    private readonly scene: SVGGElement,
  ) {
    window.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    window.addEventListener("pointerdown", (event) => this.press(event));
    window.addEventListener("pointermove", (event) => this.move(event));
    for (const end of ["pointerup", "pointercancel"] as const) {
      window.addEventListener(end, (event) => this.pointers.delete(event.pointerId));
    }
    window.addEventListener("keydown", (event) => this.key(event));
    this.resizing = new ResizeObserver(() => !this.touched && this.fit());
    this.resizing.observe(window);
  }

  close(): void {
    this.resizing.disconnect();
  }

  /** Size of the drawing [px]. */
  setSize(width: number, height: number): void {
    this.width = Math.max(1, width);
    this.height = Math.max(1, height);
    if (!this.touched) this.fit();
  }

  /** Fits the whole drawing into the window, magnified at most 1.5 times. */
  fit(): void {
    const { width, height } = this.window.getBoundingClientRect();
    if (width === 0 || height === 0) return;
    this.scale = Math.min(width / this.width, height / this.height, 1.5);
    this.x = (width - this.width * this.scale) / 2;
    this.y = (height - this.height * this.scale) / 2;
    this.touched = false;
    this.apply();
  }

  /** Zooms about a point of the window [px], by default its centre. */
  zoom(factor: number, at?: { x: number; y: number }): void {
    const { width, height } = this.window.getBoundingClientRect();
    const { x, y } = at ?? { x: width / 2, y: height / 2 };
    const scale = Math.min(4, Math.max(0.1, this.scale * factor));
    this.x = x - ((x - this.x) * scale) / this.scale;
    this.y = y - ((y - this.y) * scale) / this.scale;
    this.scale = scale;
    this.touched = true;
    this.apply();
  }

  /** Moves the drawing just enough to show a point of it. */
  reveal(x: number, y: number): void {
    const { width, height } = this.window.getBoundingClientRect();
    const edge = 60; // [px]
    const shift = (at: number, room: number): number =>
      at < edge ? edge - at : at > room - edge ? room - edge - at : 0;
    this.pan(shift(this.x + x * this.scale, width), shift(this.y + y * this.scale, height));
  }

  private pan(dx: number, dy: number): void {
    if (dx === 0 && dy === 0) return;
    this.x += dx;
    this.y += dy;
    this.touched = true;
    this.apply();
  }

  private apply(): void {
    const { x, y, scale } = this;
    this.scene.setAttribute("transform", `translate(${x} ${y}) scale(${scale})`);
    // Hides text too small to read.
    this.window.classList.toggle("far", scale < 0.55);
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const unit = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? 1 : 30;
    const { left, top } = this.window.getBoundingClientRect();
    const at = { x: event.clientX - left, y: event.clientY - top };
    this.zoom(Math.exp(-event.deltaY * unit * 0.0015), at);
  }

  private press(event: PointerEvent): void {
    if (event.button !== 0) return;
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  }

  private move(event: PointerEvent): void {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = { x: event.clientX, y: event.clientY };
    const other = [...this.pointers].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      const length = (p: { x: number; y: number }): number =>
        Math.hypot(p.x - other.x, p.y - other.y);
      const { left, top } = this.window.getBoundingClientRect();
      const middle = { x: (now.x + other.x) / 2 - left, y: (now.y + other.y) / 2 - top };
      if (length(before) > 0) this.zoom(length(now) / length(before), middle);
    } else {
      this.pan(now.x - before.x, now.y - before.y);
    }
    this.pointers.set(event.pointerId, now);
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = 60; // [px]
    const actions: Record<string, () => void> = {
      "+": () => this.zoom(1.25),
      "=": () => this.zoom(1.25),
      "-": () => this.zoom(0.8),
      "0": () => this.fit(),
    };
    if (event.target === this.window) {
      Object.assign(actions, {
        ArrowLeft: () => this.pan(step, 0),
        ArrowRight: () => this.pan(-step, 0),
        ArrowUp: () => this.pan(0, step),
        ArrowDown: () => this.pan(0, -step),
      });
    }
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  }
}
