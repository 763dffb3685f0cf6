// SPDX-License-Identifier: Apache-2.0
// Any matrix of numbers as a table.
import { numberText, type Header } from "../mtp";
import type { Arrival } from "../server";
import { fill, h, setText } from "../shell/h";
import { Pace } from "../shell/pace";
import { columnsOf, type Column } from "./columns";
import { Sight } from "./room";
import type { View, ViewKind } from "./view";

const mostRows = 100;
const mostColumns = 50;

export class TableView implements View {
  private readonly table = h("table.numbers.mono");
  private readonly more = h("p.muted");
  readonly element = h("div.table-view", { tabindex: 0 }, [this.table, this.more]);
  private readonly sight = new Sight(this.element);
  private readonly pace = new Pace(100); // [ms], faster than anyone can read
  private cells: HTMLTableCellElement[] = [];
  private shape = "";

  /** @param declared  columns. */
  constructor(private readonly declared: readonly string[]) {}

  show(arrival: Arrival): void {
    this.pace.run(() => this.draw(arrival));
  }

  close(): void {
    this.pace.close();
    this.sight.close();
  }

  private draw({ message }: Arrival): void {
    const { header, elements } = message;
    const shape = `${header.width} ${header.height} ${header.components}`;
    if (shape !== this.shape) this.build(header, shape);
    const inRow = header.width * header.components;
    const columns = Math.min(inRow, mostColumns);
    this.cells.forEach((cell, i) => {
      const number = elements[Math.floor(i / columns) * inRow + (i % columns)]!;
      setText(cell, shortText(number, header));
    });
  }

  private build(header: Header, shape: string): void {
    this.shape = shape;
    const { width, height, components } = header;
    const rows = width === 0 ? 0 : Math.min(height, mostRows);
    const columns = Math.min(width * components, mostColumns);
    this.cells = Array.from({ length: rows * columns }, () => h("td"));
    const names = columnsOf(header, this.declared).slice(0, columns);
    const title = ({ name, unit }: Column) => [name, unit && h("span.unit", ` ${unit}`)];
    if (rows === 1) {
      // A single row stands upright, so that all its names are seen.
      const upright = this.cells.map((cell, i) =>
        h("tr", [h("th", { scope: "row" }, title(names[i]!)), cell]),
      );
      fill(this.table, h("tbody", upright));
    } else
      fill(
        this.table,
        h(
          "thead",
          h("tr", [h("td"), names.map((column) => h("th", { scope: "col" }, title(column)))]),
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
        : rows < height || columns < width * components
          ? `The first ${rows} × ${columns} of ${height} rows × ${width * components} columns.`
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
  make: ({ about }) => new TableView(about.columns),
};

/** The default view of tables with several elements and of other transformations than poses. */
export const matrixView: ViewKind = {
  ...tableView,
  fits: ({ type, width, height }) =>
    type === "transformation" || (type === "table" && width * height !== 1),
};
