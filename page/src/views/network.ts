// SPDX-License-Identifier: Apache-2.0
// Dense and sparse graphs, drawn with their nodes on a circle.
import type { Arrival } from "../server";
import { arrowHead, fill, h, svg } from "../shell/h";
import { networkOf, type Edge } from "./edges";
import type { View, ViewKind } from "./view";

const mostNodes = 200;
const mostEdges = 2000;
const radius = 90;

interface Point {
  readonly x: number;
  readonly y: number;
}

export class NetworkView implements View {
  private readonly drawing = svg("svg", { viewBox: "-110 -110 220 220", role: "img" });
  private readonly words = h("p.muted");
  readonly element = h("div.network-view.stack", [this.words, this.drawing]);
  private drawn = 0;
  private timer?: number;

  show(arrival: Arrival): void {
    clearTimeout(this.timer);
    const wait = this.drawn + 200 - performance.now();
    if (wait > 0) this.timer = window.setTimeout(() => this.draw(arrival), wait);
    else this.draw(arrival);
  }

  close(): void {
    clearTimeout(this.timer);
  }

  private draw({ message }: Arrival): void {
    this.drawn = performance.now();
    const { nodes, edges } = networkOf(message);
    const shown = Math.min(nodes, mostNodes);
    const lines = edges.filter(({ from, to }) => from < shown && to < shown).slice(0, mostEdges);
    const words = `${nodes} nodes, ${edges.length} edges`;
    const isAll = shown === nodes && lines.length === edges.length;
    this.words.textContent = isAll ? words : `${words}; ${shown} and ${lines.length} drawn`;
    this.drawing.setAttribute("aria-label", words);
    const most = Math.max(1e-12, ...lines.map(sizeOf));
    const size = Math.max(1.5, Math.min(7, 180 / Math.max(1, shown)));
    const at = (node: number): Point => {
      const angle = (2 * Math.PI * node) / Math.max(1, shown) - Math.PI / 2;
      return { x: radius * Math.cos(angle), y: radius * Math.sin(angle) };
    };
    fill(
      this.drawing,
      arrowHead("network-arrow-head", 6, {
        refX: 6,
        markerWidth: 5,
        markerHeight: 5,
        orient: "auto",
      }),
      ...lines.map((edge) => edgeLine(edge, at(edge.from), at(edge.to), size, sizeOf(edge) / most)),
      ...Array.from({ length: shown }, (_, node) => {
        const { x, y } = at(node);
        return svg("g", [
          svg("circle.network-node", { cx: x, cy: y, r: size }),
          shown <= 60
            ? svg("text.network-name", { x, y, "font-size": size * 1.1 }, String(node))
            : null,
        ]);
      }),
    );
  }
}

/** Largest weight of an edge; 1 if it has none. */
function sizeOf({ weights }: Edge): number {
  return weights.length === 0 ? 1 : Math.max(...weights.map(Math.abs));
}

function edgeLine(
  edge: Edge,
  from: Point,
  to: Point,
  nodeSize: number,
  strength: number,
): SVGElement {
  const title = svg("title", `${edge.from} → ${edge.to}: ${edge.weights.join(", ")}`);
  const look = {
    class: `network-edge${(edge.weights[0] ?? 1) < 0 ? " negative" : ""}`,
    "stroke-width": 0.3 + 1.2 * strength,
    "stroke-opacity": 0.25 + 0.75 * strength,
    "marker-end": "url(#network-arrow-head)",
  };
  if (edge.from === edge.to) {
    const r = nodeSize * 1.2;
    const [x, y] = [from.x * (1 + nodeSize / radius), from.y * (1 + nodeSize / radius)];
    return svg("circle", { ...look, "marker-end": undefined, cx: x, cy: y, r }, title);
  }
  // Slightly curved, so that opposite edges are separate, and ended at the node's rim.
  const length = Math.hypot(to.x - from.x, to.y - from.y);
  const bend = {
    x: (from.x + to.x) / 2 - (to.y - from.y) * 0.12,
    y: (from.y + to.y) / 2 + (to.x - from.x) * 0.12,
  };
  const part = nodeSize / length;
  const end = { x: to.x + (bend.x - to.x) * part * 2, y: to.y + (bend.y - to.y) * part * 2 };
  return svg(
    "path",
    { ...look, d: `M${from.x} ${from.y} Q${bend.x} ${bend.y} ${end.x} ${end.y}` },
    title,
  );
}

export const networkView: ViewKind = {
  name: "network",
  fits: (sent) => sent.type === "dense_graph" || sent.type === "sparse_graph",
  make: () => new NetworkView(),
};
