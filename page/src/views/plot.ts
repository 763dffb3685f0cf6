// SPDX-License-Identifier: Apache-2.0
// Numbers over time.
import uPlot from "uplot";
import { numbersOf, type Header } from "../mtp";
import type { Arrival } from "../server";
import { button, fill, h, setText } from "../shell/h";
import { colour, onTheme } from "../shell/theme";
import { Sight } from "./room";
import { Series } from "./series";
import type { View, ViewKind } from "./view";

const mostColumns = 24;
const colours = 6;

const axes: Partial<Record<Header["type"], readonly string[]>> = {
  position: ["x", "y", "z", "vx", "vy", "vz", "ax", "ay", "az"],
  rotation: ["", " rate", " acceleration"].flatMap((what) =>
    ["roll", "pitch", "yaw"].map((axis) => axis + what),
  ),
};

/** Names of the numbers of a message, up to mostColumns. */
function columnNames({ type, width, height, components }: Header): string[] {
  return Array.from({ length: Math.min(mostColumns, width * height * components) }, (_, at) => {
    const element = Math.floor(at / components);
    const places = [height > 1 && Math.floor(element / width), width > 1 && element % width];
    const place = places.filter((each) => each !== false).join(",");
    const axis = axes[type]?.[at % components] ?? (components > 1 ? `[${at % components}]` : "");
    return `${place} ${axis}`.trim() || "value";
  });
}

function unitOf(header: Header): string {
  if (header.coord >= 7 && header.coord <= 10) return "px";
  if (header.type === "rotation" || header.coord === 13) return "rad";
  return header.type === "position" ? "m" : "";
}

export class PlotView implements View {
  readonly element: HTMLElement;
  readonly keepsPast = true;
  readonly tools: readonly HTMLElement[];
  private readonly span = h("select", { "aria-label": "Time shown", onchange: () => this.draw() }, [
    h("option", { value: 10 }, "10 s"),
    h("option", { value: 30, selected: true }, "30 s"),
    h("option", { value: 120 }, "2 min"),
    h("option", { value: 600 }, "10 min"),
  ]);
  private readonly buttons = h("div.series-buttons.wrap");
  private readonly room = h("div.plot-room");
  private readonly slider = h("input", {
    type: "range",
    min: 0,
    max: 1000,
    value: 1000,
    hidden: true,
    "aria-label": "Scroll back",
    oninput: () => this.draw(),
  });
  private readonly ends: readonly (() => void)[];
  private series?: Series;
  private names: string[] = [];
  private shape = "";
  private chosen = new Set<number>();
  private plot?: uPlot;
  private isPaused = false;
  private isNew = false;
  private values: HTMLElement[] = [];
  private last: ArrayLike<number> = [];
  private unit = "";

  constructor() {
    this.element = h("div.stack", [this.buttons, this.room, this.slider]);
    this.tools = [this.span];
    const sight = new Sight(this.element);
    const observer = new ResizeObserver(() => this.resize());
    observer.observe(this.room);
    const timer = setInterval(() => {
      if (this.isNew && !this.isPaused && sight.isSeen) this.draw();
    }, 66);
    this.ends = [
      () => clearInterval(timer),
      () => sight.close(),
      () => observer.disconnect(),
      onTheme(() => this.build()),
    ];
  }

  show(arrival: Arrival, sent: Header): void {
    const { header } = arrival.message;
    const numbers = numbersOf(arrival.message);
    if (numbers.length === 0) return;
    const shape = `${header.type} ${header.width}x${header.height}x${header.components}`;
    const isCloud = header.width * header.height > 1 && header.type === "position";
    if (shape !== this.shape && !(isCloud && this.series)) this.start(header, shape);
    this.unit = unitOf(sent);
    const time = header.time > 0n ? Number(header.time) / 1e9 : arrival.at / 1000;
    this.series!.push(time, numbers);
    this.last = numbers;
    this.isNew = true;
  }

  setPaused(paused: boolean): void {
    this.isPaused = paused;
    this.slider.hidden = !paused;
    this.slider.value = this.slider.max;
    this.draw();
  }

  close(): void {
    for (const end of this.ends) end();
    this.plot?.destroy();
  }

  private start(header: Header, shape: string): void {
    this.shape = shape;
    this.names = columnNames(header);
    this.series = new Series(this.names.length);
    this.chosen = new Set(this.names.slice(0, 3).keys());
    this.values = this.names.map(() => h("span.mono"));
    const buttons = this.names.map((name, i) => {
      const pressed = String(this.chosen.has(i));
      const one = button([name, " ", this.values[i]], () => this.choose(i, one), {
        class: "series-button",
        "aria-pressed": pressed,
      });
      one.style.setProperty("--series", `var(--series-${(i % colours) + 1})`);
      return one;
    });
    fill(this.buttons, buttons);
    this.build();
  }

  private choose(which: number, button: HTMLElement): void {
    if (!this.chosen.delete(which)) this.chosen.add(which);
    button.setAttribute("aria-pressed", String(this.chosen.has(which)));
    this.build();
  }

  /** Rebuilds the plot after a change of its series or colours. */
  private build(): void {
    if (!this.series) return;
    this.plot?.destroy();
    const axis = {
      stroke: colour("muted"),
      grid: { stroke: colour("line"), width: 1 },
      ticks: { show: false },
    };
    const options: uPlot.Options = {
      width: Math.max(80, this.room.clientWidth),
      height: Math.max(60, this.room.clientHeight),
      legend: { show: false },
      cursor: { y: false },
      scales: { x: { time: true } },
      axes: [
        { ...axis, values: (_, ticks) => ticks.map(clock) },
        {
          ...axis,
          size: 60,
          values: (_, ticks) => ticks.map((tick) => String(Number(tick.toPrecision(6)))),
        },
      ],
      series: [
        {},
        ...[...this.chosen].map((i) => ({
          label: this.names[i]!,
          stroke: colour(`series-${(i % colours) + 1}`),
          width: 1.5,
          points: { show: false },
        })),
      ],
      hooks: { setCursor: [(plot) => this.showValues(plot)] },
    };
    this.plot = new uPlot(options, [[], ...[...this.chosen].map(() => [])], this.room);
    this.draw();
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.room;
    if (width > 0 && height > 0) this.plot?.setSize({ width, height });
  }

  private draw(): void {
    const { series, plot } = this;
    if (!series || !plot || series.length === 0) return;
    this.isNew = false;
    const span = Number(this.span.value);
    const first = Math.min(series.lastTime, series.firstTime + span);
    const to = first + (Number(this.slider.value) / 1000) * (series.lastTime - first);
    const data = series.window(to - span, to, [...this.chosen]);
    plot.setData(data as uPlot.AlignedData, false);
    plot.batch(() => {
      plot.setScale("x", { min: to - span, max: to });
    });
    this.showValues(plot);
  }

  /** Shows the numbers at the cursor, else the last ones. */
  private showValues(plot: uPlot): void {
    const index = plot.cursor.idx;
    const chosen = [...this.chosen];
    this.values.forEach((element, i) => {
      const at = chosen.indexOf(i) + 1;
      const value =
        index !== null && index !== undefined && at > 0 ? plot.data[at]?.[index] : this.last[i];
      const text =
        value === null || value === undefined ? "" : `${Number(value.toPrecision(4))} ${this.unit}`;
      setText(element, text);
    });
  }
}

/** The time of day of a time [s since 1970]. */
function clock(time: number): string {
  return new Date(time * 1000).toTimeString().slice(0, 8);
}

const never = ["string", "rgb_image", "intensity_image", "vector_field", "map", "sound"];

export const plotView: ViewKind = {
  name: "plot",
  fits: (sent) => !never.includes(sent.type) && sent.width * sent.height * sent.components > 0,
  make: () => new PlotView(),
};
