// SPDX-License-Identifier: Apache-2.0
// Modules and links of a graph as tables, for screen readers, phones, and those who prefer lists.
import type { GraphLink, GraphModule, GraphState } from "../server";
import { h, setText } from "../shell";
import { linkKey } from "./structure";
import {
  bytesText,
  limitTexts,
  durationText,
  linkCondition,
  moduleCondition,
  percentText,
  rateText,
} from "./words";

interface Column<Row> {
  readonly title: string;
  text(row: Row): string;
  /** Makes the cell a button. */
  readonly open?: (row: Row) => void;
}

/** A table whose rows keep their elements while their contents change. */
class LiveTable<Row> {
  private readonly body = h("tbody");
  readonly element: HTMLElement;
  private readonly rows = new Map<string, { element: HTMLTableRowElement; cells: HTMLElement[] }>();
  private readonly data = new Map<string, Row>();

  constructor(
    caption: string,
    private readonly columns: readonly Column<Row>[],
    private readonly keyOf: (row: Row) => string,
    private readonly classOf: (row: Row) => string,
  ) {
    const titles = columns.map(({ title }) => h("th", { scope: "col" }, title));
    this.element = h(
      "div.table-window",
      { tabindex: 0, role: "region", "aria-label": caption },
      h("table.live-table", [h("caption", caption), h("thead", h("tr", titles)), this.body]),
    );
  }

  update(rows: readonly Row[]): void {
    const keys = rows.map(this.keyOf);
    for (const [key, { element }] of this.rows) {
      if (keys.includes(key)) continue;
      element.remove();
      this.rows.delete(key);
    }
    rows.forEach((row, i) => {
      const key = keys[i]!;
      this.data.set(key, row);
      const { element, cells } = this.rows.get(key) ?? this.add(key);
      if (this.body.children[i] !== element)
        this.body.insertBefore(element, this.body.children[i] ?? null);
      if (element.className !== this.classOf(row)) element.className = this.classOf(row);
      this.columns.forEach((column, j) => {
        const text = column.text(row);
        setText(cells[j]!, text);
      });
    });
  }

  private add(key: string): { element: HTMLTableRowElement; cells: HTMLElement[] } {
    const cells = this.columns.map(({ open }) =>
      open ? h("button.cell-button", { onclick: () => open(this.data.get(key)!) }) : h("span"),
    );
    const element = h(
      "tr",
      cells.map((cell, j) => (j === 0 ? h("th", { scope: "row" }, cell) : h("td", cell))),
    );
    const row = { element, cells };
    this.rows.set(key, row);
    return row;
  }
}

export interface TableEvents {
  openModule(name: string): void;
  openLink(link: GraphLink): void;
}

/** Both tables. */
export class Tables {
  private readonly modules: LiveTable<GraphModule>;
  private readonly links: LiveTable<GraphLink>;
  readonly element: HTMLElement;

  constructor(events: TableEvents) {
    this.modules = new LiveTable<GraphModule>(
      "Modules",
      [
        { title: "module", text: (m) => m.name, open: (m) => events.openModule(m.name) },
        { title: "group", text: (m) => m.group },
        { title: "task", text: (m) => m.mode },
        { title: "status", text: (m) => moduleCondition(m).why || m.status },
        { title: "cpu", text: (m) => percentText(m.cpu) },
        { title: "memory", text: (m) => bytesText(m.memory) },
        { title: "restarts", text: (m) => String(m.restarts) },
      ],
      (module) => module.name,
      (module) => moduleCondition(module).is + (module.in_workspace ? " in-workspace" : ""),
    );
    this.links = new LiveTable<GraphLink>(
      "Links",
      [
        { title: "from", text: (l) => l.from, open: (l) => events.openLink(l) },
        { title: "to", text: (l) => l.to },
        { title: "status", text: (l) => l.status || "works" },
        { title: "rate", text: (l) => rateText(l.per_second) || "0/s" },
        { title: "data", text: (l) => `${bytesText(l.bytes_per_second)}/s` },
        { title: "latency, median", text: (l) => (l.age ? durationText(l.age[0]) : "") },
        { title: "p99", text: (l) => (l.age ? durationText(l.age[1]) : "") },
        { title: "limit, late or dropped", text: (l) => limitTexts(l).join("; ") },
      ],
      linkKey,
      (link) => linkCondition(link).is + (link.in_workspace ? " in-workspace" : ""),
    );
    this.element = h("div.graph-tables", [this.modules.element, this.links.element]);
  }

  update(state: GraphState): void {
    this.modules.update(state.modules);
    this.links.update(state.links);
  }
}
