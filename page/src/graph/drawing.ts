// SPDX-License-Identifier: Apache-2.0
// The drawing of a graph: laid out once for a structure; its texts and colours are updated.
import { moduleOf, portOf, type GraphLink } from "../server";
import { arrowHead, fill, h, setText, svg } from "../shell";
import { labelLetters, type Point } from "./labels";
import { layoutOf } from "./layout";
import { drawEdge, drawNode, shorten, type EdgeMark, type NodeMark } from "./marks";
import { sayingOf, type Now } from "./says";
import { angleText, type Pose } from "../views/pose";
import { isBackground } from "./parts";
import { linkKey, structureKey, structureOf, type Edge, type Structure } from "./structure";
import { Viewport } from "./viewport";
import {
  degreesText,
  durationText,
  latencyText,
  limitTexts,
  linkCondition,
  percentText,
  rateText,
} from "./words";

/** For how long a pose is shown after it came [ms]. */
const longestPose = 2000;

export interface DrawingEvents {
  openModule(name: string): void;
  /** @param at  where the link is [px of the window]. */
  openEdge(edge: Edge, at: Point): void;
}

/** A target of the keyboard: a node, a link, or the caption that closes an open part. */
interface Item {
  readonly key: string;
  readonly element: SVGGElement;
  readonly at: Point;
}

/** As setText(), for an attribute. */
function setAttribute(element: Element, name: string, value: string): void {
  if (element.getAttribute(name) !== value) element.setAttribute(name, value);
}

export class Drawing {
  private readonly lines = svg("g");
  private readonly words = svg("g");
  private readonly boxes = svg("g");
  private readonly svg = svg(
    "svg.graph-drawing",
    { role: "group", "aria-label": "Drawing of the graph" },
    [
      arrowHead("arrow", 8, {
        refX: 7,
        markerWidth: 9,
        markerHeight: 9,
        markerUnits: "userSpaceOnUse",
      }),
      this.lines,
      this.words,
      this.boxes,
    ],
  );
  readonly element = h(
    "div.graph-window",
    { tabindex: 0, role: "region", "aria-label": "Graph; arrow keys go from one to the next" },
    this.svg,
  );
  readonly viewport = new Viewport(this.element, this.svg);
  private nodes: readonly NodeMark[] = [];
  private edges: readonly EdgeMark[] = [];
  private items: readonly Item[] = [];
  private structure?: Structure;
  private structureKey = "";
  private now?: Now;
  /** The last poses, by output. */
  private readonly turned = new Map<string, { readonly pose: Pose; readonly at: number }>();
  /** Hides poses that are too old, also while nothing comes. */
  private readonly ageing = window.setInterval(() => {
    for (const mark of this.nodes) this.updatePose(mark);
  }, 500);
  /** Keys of the parts that are open. */
  private readonly open = new Set<string>();
  /** Key of the item in the tab order; arrow keys continue from it. */
  private current = "";

  constructor(private readonly events: DrawingEvents) {
    this.element.addEventListener("keydown", (event) => this.key(event));
    this.svg.addEventListener("focusin", ({ target }) => {
      const reached = this.items.find(({ element }) => element === target);
      if (reached) this.moveTo(reached);
    });
  }

  close(): void {
    clearInterval(this.ageing);
    this.viewport.close();
  }

  /** Also shows the links of the focus, of stops and of poses, which lead nearly everywhere. */
  showBackground(show: boolean): void {
    this.svg.classList.toggle("with-background", show);
  }

  update(now: Now): void {
    this.now = now;
    const { state, frames } = now;
    const key = structureKey(state, this.open, frames);
    if (key !== this.structureKey) this.build(structureOf(state, this.open, frames));
    this.structureKey = key;
    const links = new Map(state.links.map((link) => [linkKey(link), link]));
    const loop = new Set<string>(); // keys of nodes
    for (const mark of this.edges) {
      const those = mark.edge.links.flatMap((each) => links.get(each) ?? []);
      const isLoop = this.updateEdge(mark, those);
      if (isLoop) loop.add(mark.edge.from).add(mark.edge.to);
    }
    for (const mark of this.nodes) this.updateNode(mark, now, loop.has(mark.node.key));
  }

  /** The outputs whose poses it shows. */
  get poses(): ReadonlySet<string> {
    return new Set(this.nodes.flatMap(({ node }) => node.pose || []));
  }

  /** Shows how the frame is turned that an output moves. */
  showPose(port: string, pose: Pose): void {
    this.turned.set(port, { pose, at: performance.now() });
    for (const mark of this.nodes) if (mark.node.pose === port) this.updatePose(mark);
  }

  /** Opens a part into its modules, or closes it; the clicked node stays in place. */
  private toggle(key: string): void {
    const before = this.cornerOf(key);
    if (!this.open.delete(key)) this.open.add(key);
    if (this.now) this.update(this.now);
    const now = this.cornerOf(key);
    if (before && now) this.viewport.keep(before, now);
    this.items.find((item) => item.key === key)?.element.focus({ preventScroll: true });
  }

  /** The upper left corner of a node, or of the first one of an open part. */
  private cornerOf(key: string): Point | undefined {
    const mark = this.nodes.find(({ node }) => node.key === key || node.part === key);
    return mark && { x: mark.box.x - mark.box.width / 2, y: mark.box.y - mark.box.height / 2 };
  }

  private build(structure: Structure): void {
    const layout = layoutOf(structure);
    const hadFocus = this.svg.contains(document.activeElement);
    this.nodes = structure.nodes.map((node) =>
      drawNode(
        node,
        layout.nodes.get(node.key)!,
        () => {
          const [only, ...others] = node.members;
          if (others.length > 0) this.toggle(node.key);
          else if (only !== undefined) this.events.openModule(only);
        },
        () => this.toggle(node.part),
      ),
    );
    this.edges = structure.edges.map((edge) => {
      const mark: EdgeMark = drawEdge(edge, layout.edges.get(edge.key)!, () =>
        this.events.openEdge(edge, this.placeOf(mark)),
      );
      return mark;
    });
    fill(
      this.lines,
      this.edges.map(({ group }) => group),
    );
    fill(
      this.words,
      this.edges.map(({ words }) => words),
    );
    fill(
      this.boxes,
      this.nodes.map(({ element }) => element),
    );
    const captions = this.nodes.filter(({ node }) => node.part !== "");
    this.items = [
      ...captions.map(({ node, caption, box }) => ({ key: node.part, element: caption, at: box })),
      ...this.nodes.map(({ node, group, box }) => ({ key: node.key, element: group, at: box })),
      ...this.edges.map(({ edge, group, at }) => ({ key: edge.key, element: group, at })),
    ].sort((a, b) => a.at.x - b.at.x || a.at.y - b.at.y);
    const current = this.items.find(({ key }) => key === this.current) ?? this.items[0];
    if (current) this.moveTo(current);
    if (hadFocus) current?.element.focus({ preventScroll: true });
    const workspace = this.nodes.find(({ node }) => node.kind === "workspace")?.box;
    if (workspace) {
      const { x, y, width, height } = workspace;
      this.viewport.openAt({ x: x + 0.6 * width, y: y + 0.6 * height });
    }
    this.viewport.setSize(layout.width, layout.height, this.open.size > 0);
    this.structure = structure;
  }

  private updateNode(mark: NodeMark, now: Now, isLoop: boolean): void {
    const { node, group, title, detail, box } = mark;
    const { state } = now;
    const members = state.modules.filter(({ name }) => node.members.includes(name));
    const saying = sayingOf(node, this.structure?.edges ?? [], now);
    const hasFocus = members.some(
      ({ mode, workspace }) => mode !== "" && mode === state.focus[workspace]?.mode,
    );
    const classes = ["node", `kind-${node.kind}`, saying.is];
    if (isLoop) classes.push("in-workspace");
    if (hasFocus) classes.push("has-focus");
    setAttribute(group, "class", classes.join(" "));
    setText(detail, shorten(saying.text, box.width, "detail"));
    this.updatePose(mark);
    const loads = members.map(({ name, cpu }) => `${name}, cpu ${percentText(cpu)}`);
    const focus = hasFocus ? ", has the focus" : "";
    const pose = this.poseOf(node);
    const turned = pose
      ? [
          `pan ${angleText(pose.pan, "left", "right", 0)}, tilt ${angleText(pose.tilt, "down", "up", 0)}`,
        ]
      : [];
    // Also its name for screen readers.
    setText(title, [`${node.label}${focus}: ${saying.text}`, ...turned, ...loads].join("\n"));
  }

  /** The latest pose of the frame that a node moves, unless it is too old. */
  private poseOf({ pose }: NodeMark["node"]): Pose | undefined {
    const last = this.turned.get(pose);
    return last && performance.now() - last.at < longestPose ? last.pose : undefined;
  }

  private updatePose({ node, pose, pan, tilt }: NodeMark): void {
    const turned = this.poseOf(node);
    setAttribute(pose, "display", turned ? "inline" : "none");
    if (!turned) return;
    setText(pan, `pan ${degreesText(turned.pan)}`);
    setText(tilt, `tilt ${degreesText(turned.tilt)}`);
  }

  /** @returns  whether it moves the robot now: something passes it in the global workspace. */
  private updateEdge(mark: EdgeMark, all: readonly GraphLink[]): boolean {
    const { background, from, to } = mark.edge;
    const links = all.filter((link) => background || !isBackground(link));
    const fastest = links.reduce((a, b) => (b.per_second > a.per_second ? b : a));
    const isBroken = links.some((link) => linkCondition(link).is === "broken");
    const isLoop = links.some((link) => link.in_workspace && link.per_second > 0) && !background;
    const classes = [background ? "background" : "data"];
    if (isBroken) classes.push("broken");
    if (isLoop) classes.push("in-workspace");
    if (fastest.per_second === 0) classes.push("silent");
    setAttribute(mark.group, "class", ["edge", ...classes].join(" "));
    setAttribute(mark.words, "class", ["edge-words", ...classes].join(" "));
    const rate = isBroken ? "broken" : rateText(fastest.per_second);
    const age = fastest.age ? durationText(fastest.age[0]) : "";
    setText(mark.rate, rate);
    setText(mark.age, age && rate.length + 1 + age.length <= labelLetters ? ` ${age}` : "");
    setText(mark.title, all.map(linkText).join("\n"));
    const label = (key: string): string =>
      this.nodes.find(({ node }) => node.key === key)?.node.label ?? key;
    const facts = [rate || "no messages", age].filter((fact) => fact !== "").join(", ");
    setAttribute(mark.group, "aria-label", `Link from ${label(from)} to ${label(to)}: ${facts}`);
    return isLoop;
  }

  /** Where the line of a link begins in the window [px]. */
  private placeOf({ at }: EdgeMark): Point {
    const matrix = this.svg.getScreenCTM();
    const { x, y } = new DOMPoint(at.x, at.y).matrixTransform(matrix ?? undefined);
    return { x, y };
  }

  private moveTo(item: Item): void {
    this.current = item.key;
    for (const { element } of this.items) {
      setAttribute(element, "tabindex", element === item.element ? "0" : "-1");
    }
  }

  private key(event: KeyboardEvent): void {
    const at = this.items.findIndex(({ element }) => element === event.target);
    const item = this.items[at];
    if (!item || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "Enter" || event.key === " ") {
      item.element.dispatchEvent(new MouseEvent("click"));
    } else {
      const ways: Record<string, () => Item | undefined> = {
        ArrowDown: () => this.shownItem(at, 1),
        ArrowUp: () => this.shownItem(at, -1),
        ArrowRight: () => this.neighbour(item, 1),
        ArrowLeft: () => this.neighbour(item, -1),
      };
      const way = ways[event.key];
      if (!way) return;
      way()?.element.focus();
    }
    event.preventDefault();
  }

  /** The next or previous item that is shown, column by column. */
  private shownItem(at: number, step: 1 | -1): Item | undefined {
    for (let i = at + step; this.items[i]; i += step) {
      if (getComputedStyle(this.items[i]!.element).display !== "none") return this.items[i];
    }
    return undefined;
  }

  /** The nearest item to the right or left; distance up and down counts double. */
  private neighbour({ at }: Item, way: 1 | -1): Item | undefined {
    const distance = (item: Item): number => {
      const along = (item.at.x - at.x) * way;
      const isShown = getComputedStyle(item.element).display !== "none";
      return along > 5 && isShown ? along + 2 * Math.abs(item.at.y - at.y) : Infinity;
    };
    const nearest = this.items.reduce((a, b) => (distance(b) < distance(a) ? b : a));
    return distance(nearest) < Infinity ? nearest : undefined;
  }
}

/** A link in words: its ports, status, latency and drops. */
function linkText(link: GraphLink): string {
  const facts = [
    link.status,
    rateText(link.per_second) || "no messages",
    link.age ? `latency ${latencyText(link.age)}` : "",
    ...limitTexts(link),
  ].filter((fact) => fact !== "");
  return `${link.from} → ${portOf(link.to)} of ${moduleOf(link.to)}: ${facts.join("; ")}`;
}
