// SPDX-License-Identifier: Apache-2.0
// The drawing of a graph: laid out once for a structure; its texts and colours are updated.
import type { GraphLink, GraphModule, GraphState } from "../server";
import { arrowHead, fill, h, setText, svg } from "../shell";
import { DropRates } from "./drops";
import { Failures } from "./failures";
import { layoutOf, pathThrough, type Box, type Layout, type Line, type Point } from "./layout";
import { linkKey, portOf, structureOf, type Edge, type Structure } from "./structure";
import { Viewport } from "./viewport";
import { bytesText, limitTexts, durationText, latencyText, percentText, rateText } from "./words";

export interface DrawingEvents {
  openModule(name: string): void;
  /** @param at  position of the click [px of the window]. */
  openEdge(edge: Edge, at: Point): void;
}

/** As setText(), for an attribute. */
function setAttribute(element: Element, name: string, value: string): void {
  if (element.getAttribute(name) !== value) element.setAttribute(name, value);
}

type NodeElements = ReturnType<typeof drawNode>;
type EdgeElements = ReturnType<typeof drawEdge>;

export class Drawing {
  private readonly groups = svg("g");
  private readonly edges = svg("g");
  private readonly nodes = svg("g");
  private readonly scene = svg("g", [this.groups, this.edges, this.nodes]);
  private readonly svg = svg(
    "svg.graph-drawing",
    { tabindex: 0, role: "group", "aria-label": "Drawing of the graph" },
    [
      arrowHead("arrow", 8, {
        refX: 7,
        markerWidth: 9,
        markerHeight: 9,
        markerUnits: "userSpaceOnUse",
      }),
      this.scene,
    ],
  );
  readonly element = h("div.graph-window", this.svg);
  readonly viewport = new Viewport(this.svg, this.scene);
  private nodeElements = new Map<string, NodeElements>();
  private edgeElements: readonly EdgeElements[] = [];
  private readonly drops = new DropRates();
  private readonly failures = new Failures();
  private structure?: Structure;
  /** The module in the tab order; arrow keys continue from it. */
  private current = "";

  constructor(private readonly events: DrawingEvents) {
    this.svg.addEventListener("keydown", (event) => this.key(event));
  }

  close(): void {
    this.viewport.close();
  }

  /** Also shows the links of the focus and of poses, which lead nearly everywhere. */
  showBackground(show: boolean): void {
    this.svg.classList.toggle("with-background", show);
  }

  update(state: GraphState): void {
    const structure = structureOf(state);
    if (structure.key !== this.structure?.key) this.build(structure);
    this.structure = structure;
    this.drops.take(state);
    this.failures.take(state);
    for (const module of state.modules) this.updateNode(module, state);
    const links = new Map(state.links.map((link) => [linkKey(link), link]));
    for (const elements of this.edgeElements) {
      const those = elements.edge.links.flatMap((key) => links.get(key) ?? []);
      if (those.length > 0) this.updateEdge(elements, those);
    }
  }

  private build(structure: Structure): void {
    const layout = layoutOf(structure);
    const focused = this.nodeElements.get(this.current)?.group === document.activeElement;
    this.groups.replaceChildren(...layout.groups.map(drawGroup));
    this.edgeElements = structure.edges.map((edge) =>
      drawEdge(edge, layout.edges.get(edge.key)!, (at) => this.events.openEdge(edge, at)),
    );
    fill(
      this.edges,
      this.edgeElements.map(({ group }) => group),
    );
    this.nodeElements = new Map(
      structure.nodes.map(({ name }) => {
        const open = () => this.events.openModule(name);
        return [name, drawNode(name, layout.nodes.get(name)!, open, () => this.moveTo(name))];
      }),
    );
    fill(
      this.nodes,
      [...this.nodeElements.values()].map(({ group }) => group),
    );
    if (!this.nodeElements.has(this.current)) this.current = structure.nodes[0]?.name ?? "";
    this.nodeElements.get(this.current)?.group.setAttribute("tabindex", "0");
    if (focused) this.nodeElements.get(this.current)?.group.focus();
    this.viewport.setSize(layout.width, layout.height);
  }

  private updateNode(module: GraphModule, state: GraphState): void {
    const elements = this.nodeElements.get(module.name);
    if (!elements) return;
    const { is, why } = this.failures.conditionOf(module);
    const load = `${percentText(module.cpu)} · ${bytesText(module.memory)}`;
    const isTask = module.mode !== "" && module.mode === state.focus[module.workspace]?.mode;
    const classes = ["node", is];
    if (module.in_workspace) classes.push("in-workspace");
    if (isTask) classes.push("task");
    if (!module.in_focus) classes.push("idle");
    if (module.name in state.focus) classes.push("arbiter");
    setAttribute(elements.group, "class", classes.join(" "));
    const room = Math.floor((elements.box.width - 16) / 6.2);
    setText(elements.detail, why ? shorten(why, room) : load);
    setText(elements.mode, module.mode);
    const width = (elements.box.width - 4) * Math.min(1, module.cpu);
    setAttribute(elements.load, "width", width.toFixed(1));
    const mode = module.mode && `, task ${module.mode}${isTask ? " has the focus" : ""}`;
    const condition = why ? `: ${why}` : "";
    const text = `${module.name}${mode}${condition}; ${load}`;
    setText(elements.title, text); // also its name for screen readers
  }

  private updateEdge(elements: EdgeElements, links: readonly GraphLink[]): void {
    const fastest = links.reduce((a, b) => (b.per_second > a.per_second ? b : a));
    const broken = links.filter((link) => link.status !== "");
    const dropped = links.reduce((sum, link) => sum + this.drops.of(link), 0);
    const classes = ["edge"];
    if (elements.edge.background) classes.push("background");
    if (broken.length > 0) classes.push("broken");
    if (links.some((link) => link.in_workspace)) classes.push("in-workspace");
    if (links.every((link) => link.per_second === 0)) classes.push("silent");
    setAttribute(elements.group, "class", classes.join(" "));
    const several = links.length > 1 ? ` ×${links.length}` : "";
    setText(elements.rate, broken[0] ? "broken" : rateText(fastest.per_second) + several);
    setText(elements.dropped, dropped >= 0.05 ? ` −${rateText(dropped)}` : "");
    const { age } = fastest;
    setText(elements.latency, age ? `${durationText(age[0])} · ${durationText(age[1])}` : "");
    setText(elements.title, links.map(linkText).join("\n"));
  }

  private moveTo(name: string): void {
    this.nodeElements.get(this.current)?.group.setAttribute("tabindex", "-1");
    this.current = name;
    const elements = this.nodeElements.get(name);
    elements?.group.setAttribute("tabindex", "0");
    if (elements) this.viewport.reveal(elements.box.x, elements.box.y);
  }

  private key(event: KeyboardEvent): void {
    const name = (event.target as Element).getAttribute("data-module");
    if (name === null) return;
    if (event.key === "Enter" || event.key === " ") {
      event.preventDefault();
      return this.events.openModule(name);
    }
    const ways: Record<string, Point> = {
      ArrowLeft: { x: -1, y: 0 },
      ArrowRight: { x: 1, y: 0 },
      ArrowUp: { x: 0, y: -1 },
      ArrowDown: { x: 0, y: 1 },
    };
    const way = ways[event.key];
    if (!way) return;
    event.preventDefault();
    this.neighbour(name, way)?.group.focus();
  }

  /** The nearest module in a direction; sideways distance counts double. */
  private neighbour(name: string, way: Point): NodeElements | undefined {
    const here = this.nodeElements.get(name)?.box;
    if (!here) return undefined;
    const distance = ({ box }: NodeElements): number => {
      const along = (box.x - here.x) * way.x + (box.y - here.y) * way.y;
      const aside = Math.abs((box.x - here.x) * way.y) + Math.abs((box.y - here.y) * way.x);
      return along > 5 ? along + 2 * aside : Infinity;
    };
    const all = [...this.nodeElements.values()];
    const nearest = all.reduce((a, b) => (distance(b) < distance(a) ? b : a));
    return distance(nearest) < Infinity ? nearest : undefined;
  }
}

function drawNode(name: string, box: Box, open: () => void, reached: () => void) {
  const title = svg("title");
  const left = -box.width / 2;
  const top = -box.height / 2;
  const detail = svg("text.node-detail", { x: left + 10, y: top + 37 });
  const mode = svg("text.node-mode", { x: -left - 8, y: top - 3, "text-anchor": "end" });
  const load = svg("rect.node-load", { x: left + 2, y: -top - 5, height: 3, width: 0 });
  const group = svg(
    "g.node",
    {
      role: "button",
      tabindex: -1,
      "data-module": name,
      transform: `translate(${box.x} ${box.y})`,
      onclick: open,
      onfocus: reached,
    },
    [
      title,
      svg("rect.node-box", { x: left, y: top, width: box.width, height: box.height, rx: 6 }),
      svg("text.node-name", { x: left + 10, y: top + 20 }, name),
      detail,
      mode,
      load,
    ],
  );
  return { group, title, detail, mode, load, box };
}

function drawEdge(edge: Edge, { points, label }: Line, open: (at: Point) => void) {
  const d = pathThrough(points);
  const title = svg("title");
  const rate = svg("tspan.edge-rate");
  const dropped = svg("tspan.edge-dropped");
  const latency = svg("text.edge-latency", { x: label.x, y: label.y + 12 });
  const group = svg(
    "g",
    {
      class: edge.background ? "edge background" : "edge",
      "data-edge": edge.key,
      onclick: (event: MouseEvent) => open({ x: event.clientX, y: event.clientY }),
    },
    [
      title,
      svg("path.edge-line", { d, "marker-end": "url(#arrow)" }),
      svg("path.edge-hit", { d }),
      svg("text.edge-label", { x: label.x, y: label.y - 2 }, [rate, dropped]),
      latency,
    ],
  );
  return { group, title, rate, dropped, latency, edge };
}

function drawGroup({ group, box }: Layout["groups"][number]): SVGGElement {
  const x = box.x - box.width / 2;
  const y = box.y - box.height / 2;
  const { width, height } = box;
  return svg("g.group", [
    svg("rect", { x, y, width, height, rx: 10 }),
    svg("text", { x: x + 10, y: y + 16 }, group),
  ]);
}

/** A link in words: its ports, status, latency and drops. */
function linkText(link: GraphLink): string {
  const facts = [
    link.status,
    rateText(link.per_second) || "nothing comes",
    link.age ? `latency ${latencyText(link.age)}` : "",
    ...limitTexts(link),
  ].filter((fact) => fact !== "");
  return `${link.from} → ${portOf(link.to)} of ${link.to.split(".")[0]}: ${facts.join("; ")}`;
}

function shorten(text: string, letters: number): string {
  return text.length <= letters ? text : `${text.slice(0, letters - 1)}…`;
}
