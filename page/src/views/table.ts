// SPDX-License-Identifier: Apache-2.0
// Any matrix of numbers as a table.
import { numberText, type Header } from "../mtp";
import type { Arrival } from "../server";
import { fill, h, setText } from "../shell/h";
import { Sight } from "./room";
import type { View, ViewKind } from "./view";

const mostRows = 100;
const mostColumns = 50;

export class TableView implements View {
  private readonly table = h("table.numbers.mono");
  private readonly more = h("p.muted");
  readonly element = h("div.table-view", { tabindex: 0 }, [this.table, this.more]);
  private readonly sight = new Sight(this.element);
  private drawn = 0;
  private timer?: number;
  private cells: HTMLTableCellElement[] = [];
  private shape = "";

  show(arrival: Arrival): void {
    clearTimeout(this.timer);
    const wait = this.drawn + 100 - performance.now(); // faster than anyone can read
    if (wait > 0) this.timer = window.setTimeout(() => this.draw(arrival), wait);
    else this.draw(arrival);
  }

  close(): void {
    clearTimeout(this.timer);
    this.sight.close();
  }

  private draw({ message }: Arrival): void {
    this.drawn = performance.now();
    const { header, elements } = message;
    const shape = `${header.width} ${header.height} ${header.components}`;
    if (shape !== this.shape) this.build(header, shape);
    const { components, width } = header;
    const columns = Math.min(width, mostColumns);
    this.cells.forEach((cell, i) => {
      const first = (Math.floor(i / columns) * width + (i % columns)) * components;
      const numbers = Array.from({ length: components }, (_, k) => elements[first + k]!);
      const text = numbers.map((each) => shortText(each, header)).join("  ");
      setText(cell, text);
    });
  }

  private build(header: Header, shape: string): void {
    this.shape = shape;
    const { width, height } = header;
    const rows = width === 0 ? 0 : Math.min(height, mostRows);
    const columns = Math.min(width, mostColumns);
    this.cells = Array.from({ length: rows * columns }, () => h("td"));
    fill(
      this.table,
      h(
        "thead",
        h("tr", [h("td"), Array.from({ length: columns }, (_, i) => h("th", { scope: "col" }, i))]),
      ),
      h(
        "tbody",
        Array.from({ length: rows }, (_, row) =>
          h("tr", [
            h("th", { scope: "row" }, row),
            this.cells.slice(row * columns, (row + 1) * columns),
          ]),
        ),
      ),
    );
    this.more.textContent =
      rows === 0
        ? "Empty: no rows or no elements."
        : rows < height || columns < width
          ? `The first ${rows} × ${columns} of ${height} rows × ${width} columns.`
          : "";
  }
}

function shortText(value: number | bigint, header: Header): string {
  if (typeof value === "bigint") return String(value);
  const isFloat = header.scalar === "f32" || header.scalar === "f64";
  return isFloat ? numberText(Number(value.toPrecision(7)), "f64") : String(value);
}

export const tableView: ViewKind = {
  name: "table",
  fits: (sent) => sent.type !== "string" && sent.encoding !== "jpeg",
  make: () => new TableView(),
};

/** The default view of tables with several elements and of transformations. */
export const matrixView: ViewKind = {
  ...tableView,
  fits: ({ type, width, height }) =>
    type === "transformation" || (type === "table" && width * height !== 1),
};
