// SPDX-License-Identifier: Apache-2.0
import type { GraphLink, GraphModule } from "../server";
import { button, fill, h, setText, type PanelKind } from "../shell";
import { Drawing } from "./drawing";
import { Failures } from "./failures";
import type { Point } from "./labels";
import { Poses } from "./poses";
import { summaryOf } from "./says";
import { linkKey, type Edge } from "./structure";
import { Tables } from "./table";
import { limitTexts, latencyText, rateText } from "./words";

/** The live graph: {kind: "graph", show?: "drawing" | "tables"}. */
export const graphPanel: PanelKind = (args, host) => {
  const { server } = host;
  host.setTitle("Graph");
  const openModule = (name: string): void => host.openPanel({ kind: "module", name });
  const openLink = (link: GraphLink): void => host.openPanel({ kind: "stream", port: link.from });
  const linksOfEdge = (edge: Edge): GraphLink[] =>
    server.state?.links.filter((link) => edge.links.includes(linkKey(link))) ?? [];

  const menu = h("div.edge-menu.box", { hidden: true });
  /** Chooses one of several links between two modules. */
  const choose = (edge: Edge, at: Point): void => {
    const links = linksOfEdge(edge);
    if (links.length <= 1) {
      if (links[0]) openLink(links[0]);
      return;
    }
    const buttons = links.map((link) => {
      const facts = [rateText(link.per_second), latencyText(link.age), ...limitTexts(link)];
      return h("button", { onclick: () => (closeMenu(), openLink(link)) }, [
        h("b", `${link.from} → ${link.to}`),
        h("span.small", facts.filter((fact) => fact !== "").join("; ")),
      ]);
    });
    fill(menu, buttons);
    menu.hidden = false;
    const room = element.getBoundingClientRect();
    menu.style.left = `${Math.max(4, Math.min(at.x - room.left, room.width - menu.offsetWidth - 4))}px`;
    menu.style.top = `${Math.max(4, Math.min(at.y - room.top, room.height - menu.offsetHeight - 4))}px`;
    buttons[0]?.focus();
  };
  const closeMenu = (): void => {
    menu.hidden = true;
  };
  menu.addEventListener("keydown", (event) => event.key === "Escape" && closeMenu());
  menu.addEventListener("focusout", (event) => {
    if (!menu.contains(event.relatedTarget as Node | null)) closeMenu();
  });

  const drawing = new Drawing({ openModule, openEdge: choose });
  const poses = new Poses(server, (port, pose) => drawing.showPose(port, pose));
  const tables = new Tables({ openModule, openLink });
  const counts = h("span.graph-counts.muted");
  const problems = h("span.problems", { role: "status" });
  const summary = h("p.graph-summary.small", [counts, problems]);
  const element = h("div.graph.stack", [summary, drawing.element, tables.element, menu]);

  let shown = args.show === "tables" ? "tables" : "drawing";
  const background = h("input", {
    type: "checkbox",
    onchange: () => drawing.showBackground(background.checked),
  });
  const show = (): void => {
    drawing.element.hidden = shown !== "drawing";
    tables.element.hidden = shown !== "tables";
    switcher.textContent = shown === "drawing" ? "Tables" : "Drawing";
    for (const tool of drawingTools) tool.hidden = shown !== "drawing";
    update();
  };
  const switcher = h("button", {
    onclick: () => {
      shown = shown === "drawing" ? "tables" : "drawing";
      host.setArgs({ ...args, show: shown });
      show();
    },
  });
  const zoom = (label: string, text: string, action: () => void): HTMLElement =>
    button(text, action, { "aria-label": label, title: label });
  const drawingTools = [
    h("label.tool", { title: "Also the links of focus, stops and poses" }, [
      background,
      "all links",
    ]),
    zoom("Smaller", "−", () => drawing.viewport.zoom(0.8)),
    zoom("Larger", "+", () => drawing.viewport.zoom(1.25)),
    zoom("Fit into the window", "⤢", () => drawing.viewport.fit()),
  ];
  host.tools.append(...drawingTools, switcher);

  const failures = new Failures();
  const update = (): void => {
    const { state, session } = server;
    if (!state || !session) return;
    failures.take(state);
    const now = {
      state,
      frames: session.frames,
      stopped: session.stopped === true,
      bids: (workspace: string) => server.standings.of(workspace),
      conditionOf: (module: GraphModule) => failures.conditionOf(module),
    };
    if (shown === "drawing") drawing.update(now);
    else tables.update(state);
    poses.follow(shown === "drawing" ? drawing.poses : new Set());
    const { counts: count, problems: bad } = summaryOf(now);
    setText(counts, count);
    setText(problems, bad.text);
    problems.dataset.is = bad.is;
  };
  show();
  const ends = [server.onState(update), server.onSession(update), server.onConnection(update)];
  return {
    element,
    close: () => {
      for (const end of ends) end();
      poses.close();
      drawing.close();
    },
  };
};
