// SPDX-License-Identifier: Apache-2.0
// Numbers over time.
import uPlot from "uplot";
import { numbersOf, type Header } from "../mtp";
import type { Arrival } from "../server";
import { button, fill, h, setText } from "../shell/h";
import { colour, onTheme } from "../shell/theme";
import { columnsOf, quantityText, shown } from "./columns";
import { Sight } from "./room";
import { Series } from "./series";
import type { View, ViewKind } from "./view";

const mostColumns = 24;
const colours = 6;

/** The numbers of a message, up to mostColumns: their names, and units in which they are shown. */
function numbersIn(header: Header, declared: readonly string[]): ReturnType<typeof shown>[] {
  const row = columnsOf(header, declared);
  const count = Math.min(mostColumns, row.length * header.height);
  return Array.from({ length: count }, (_, i) => {
    const { name, unit } = row[i % row.length]!;
    const place = header.height > 1 ? `${Math.floor(i / row.length)} ` : "";
    return shown({ name: place + name, unit });
  });
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
  private columns: ReturnType<typeof shown>[] = [];
  private shape = "";
  private chosen = new Set<number>();
  private plot?: uPlot;
  private isPaused = false;
  private isNew = false;
  private values: HTMLElement[] = [];
  private last: ArrayLike<number> = [];

  /** @param declared  columns. */
  constructor(private readonly declared: readonly string[]) {
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
    if (shape !== this.shape && !(isCloud && this.series))
      this.start({ ...header, coord: sent.coord }, shape);
    const time = header.time > 0n ? Number(header.time) / 1e9 : arrival.at / 1000;
    this.last = this.columns.map(({ factor }, i) => factor * numbers[i]!);
    this.series!.push(time, this.last);
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
    this.columns = numbersIn(header, this.declared);
    this.series = new Series(this.columns.length);
    this.chosen = new Set(this.columns.slice(0, 3).keys());
    this.values = this.columns.map(() => h("span.mono"));
    const buttons = this.columns.map(({ name }, i) => {
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
    const size = 0.8 * parseFloat(getComputedStyle(this.room).fontSize); // of labels [px]
    const axis = {
      font: `${size}px system-ui, sans-serif`,
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
        { ...axis, size: 2.6 * size, space: 7 * size, values: (_, ticks) => ticks.map(clock) },
        {
          ...axis,
          size: 5 * size,
          space: 4 * size,
          values: (_, ticks) => ticks.map((tick) => String(Number(tick.toPrecision(6)))),
        },
      ],
      series: [
        {},
        ...[...this.chosen].map((i) => ({
          label: this.columns[i]!.name,
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
      const isKnown = value !== null && value !== undefined;
      setText(element, isKnown ? quantityText(value, this.columns[i]!.unit) : "");
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
  make: ({ about }) => new PlotView(about.columns),
};
