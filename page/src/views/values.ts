// SPDX-License-Identifier: Apache-2.0
// Depth, disparity and other measured grids in colours, from blue (zero) to red.
import { Coord, numbersOf, type Header, type Numbers } from "../mtp";
import type { Arrival } from "../server";
import { h } from "../shell/h";
import { code, known, SlowRange, stripes, type Range } from "./coding";
import { isMeasured } from "./picture";
import { pixelAt, Probe, type Spot } from "./probe";
import { askForWidth } from "./room";
import { turbo } from "./turbo";
import type { View, ViewHost, ViewKind } from "./view";

function unitOf(header: Header): string {
  if (header.coord === Coord.depth || header.coord === Coord.right_depth) return "m";
  return header.coord === Coord.disparity ? "px" : "";
}

export class ValuesView implements View {
  readonly element: HTMLElement;
  readonly tools: readonly HTMLElement[];
  private readonly canvas = h("canvas.picture.values", { role: "img" });
  private readonly context = this.canvas.getContext("2d", { alpha: false })!;
  private readonly component = h("select", { "aria-label": "Component", hidden: true });
  private readonly fixed = h("button", {
    "aria-pressed": "false",
    title: "Keep the range of the colours",
  });
  private readonly least = h("span.mono");
  private readonly most = h("span.mono");
  private readonly middle = h("span.mono");
  private readonly holePart = h("span.hole-part");
  private readonly probe: Probe;
  private readonly endRoom: () => void;
  private image?: ImageData;
  private shown?: { arrival: Arrival; sent: Header; values: Numbers };

  /** @param range  of the colours, which views of both eyes share. */
  constructor(
    host: ViewHost,
    private readonly range = new SlowRange(),
  ) {
    this.canvas.setAttribute("aria-label", `Values of ${host.source.port} in colours`);
    this.probe = new Probe(this.canvas, (spot) => this.words(spot));
    this.fixed.textContent = "Fix colours";
    this.fixed.onclick = () => {
      this.range.isFixed = !this.range.isFixed;
      this.fixed.setAttribute("aria-pressed", String(this.range.isFixed));
    };
    this.component.onchange = () => {
      this.range.range = undefined;
      if (this.shown) this.show(this.shown.arrival, this.shown.sent);
    };
    this.tools = [this.component, this.fixed];
    const bar = h("canvas.legend-bar", { width: 256, height: 1, "aria-hidden": "true" });
    drawBar(bar);
    this.element = h("div.image-view.stack", [
      this.canvas,
      h("div.legend.row.small", [
        h("div.scale", [bar, h("div", [this.least, this.middle, this.most])]),
        h("span.hole-swatch", { "aria-hidden": "true" }),
        this.holePart,
      ]),
      this.probe.output,
    ]);
    this.endRoom = askForWidth(this.canvas, host.source, () => this.shown?.sent);
  }

  show(arrival: Arrival, sent: Header): void {
    const { message } = arrival;
    const values = numbersOf(message);
    this.shown = { arrival, sent, values };
    const { width, height, components } = message.header;
    if (width === 0 || height === 0) return;
    this.offerComponents(components);
    if (!this.image || this.image.width !== width || this.image.height !== height) {
      Object.assign(this.canvas, { width, height });
      this.image = new ImageData(width, height);
    }
    const which = Math.min(Number(this.component.value || 0), components - 1);
    this.draw(values, components, which, isMeasured(sent));
    this.context.putImageData(this.image, 0, 0);
    this.probe.update();
  }

  close(): void {
    this.endRoom();
  }

  private offerComponents(count: number): void {
    if (this.component.options.length === count) return;
    this.component.hidden = count < 2;
    this.component.replaceChildren(
      ...Array.from({ length: count }, (_, i) => h("option", { value: i }, `component ${i}`)),
    );
  }

  private draw(all: Numbers, components: number, which: number, isZeroUnknown: boolean): void {
    const values =
      components === 1
        ? all
        : Float64Array.from(
            { length: all.length / components },
            (_, i) => all[i * components + which]!,
          );
    const grid = { values, width: this.image!.width, isZeroUnknown };
    const range = this.range.update(grid, this.shown?.arrival.message.header.time || undefined);
    if (range) this.label(range);
    const pixels = new Uint32Array(this.image!.data.buffer);
    const unknown = code(grid, range, "colours", stripes, pixels);
    this.holePart.textContent = `${((100 * unknown) / pixels.length).toFixed(1)} % unknown`;
  }

  private label([least, most]: Range): void {
    const unit = this.shown ? unitOf(this.shown.sent) : "";
    const text = (value: number) => `${Number(value.toPrecision(3))} ${unit}`.trim();
    this.least.textContent = `≤ ${text(least)}`;
    this.middle.textContent = text((least + most) / 2);
    this.most.textContent = `≥ ${text(most)}`;
  }

  private words({ across, down }: Spot): string {
    if (!this.shown) return "";
    const { arrival, sent, values } = this.shown;
    const { width, height, components } = arrival.message.header;
    const { x, y } = pixelAt({ across, down }, sent.width, sent.height);
    const element = Math.floor(down * height) * width + Math.floor(across * width);
    const unit = unitOf(sent);
    const words = Array.from(values.subarray(element * components, (element + 1) * components))
      .slice(0, 8)
      .map((value) => (known(value, isMeasured(sent)) ? Number(value.toPrecision(4)) : "unknown"));
    return `${x.toFixed(0)}, ${y.toFixed(0)} px: ${words.join(" ")} ${unit}`;
  }
}

function drawBar(bar: HTMLCanvasElement): void {
  const context = bar.getContext("2d")!;
  for (let x = 0; x < bar.width; ++x) {
    context.fillStyle = `rgb(${turbo(x / (bar.width - 1)).join(" ")})`;
    context.fillRect(x, 0, 1, 1);
  }
}

const grids = ["intensity_image", "vector_field", "map", "dense_graph"];

export const valuesView: ViewKind = {
  name: "colours",
  fits: (sent) => grids.includes(sent.type),
  make: (host) => new ValuesView(host),
};

/** The default view of measurements. */
export const depthView: ViewKind = { ...valuesView, fits: isMeasured };
