// SPDX-License-Identifier: Apache-2.0
import type { GraphLink } from "../server";
import { button, fill, h, type PanelKind } from "../shell";
import { Drawing } from "./drawing";
import type { Point } from "./layout";
import { linkKey, type Edge } from "./structure";
import { Tables } from "./table";
import { limitTexts, latencyText, rateText } from "./words";
import { WorkspaceView } from "./workspace";

/** Below this width the tables are shown first [px]. */
const narrow = 480;

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
  const tables = new Tables({ openModule, openLink });
  const workspaces = h("div.workspaces");
  const views = new Map<string, WorkspaceView>();
  const element = h("div.graph.stack", [workspaces, drawing.element, tables.element, menu]);

  let chosen = args.show;
  const background = h("input", {
    type: "checkbox",
    onchange: () => drawing.showBackground(background.checked),
  });
  const show = (which: string): void => {
    drawing.element.hidden = which !== "drawing";
    tables.element.hidden = which !== "tables";
    switcher.textContent = which === "drawing" ? "Tables" : "Drawing";
    for (const tool of drawingTools) tool.hidden = which !== "drawing";
  };
  const shown = (): string => chosen ?? (element.clientWidth < narrow ? "tables" : "drawing");
  const switcher = h("button", {
    onclick: () => {
      chosen = shown() === "drawing" ? "tables" : "drawing";
      host.setArgs({ ...args, show: chosen });
      show(chosen);
    },
  });
  const zoom = (label: string, text: string, action: () => void): HTMLElement =>
    button(text, action, { "aria-label": label, title: label });
  const drawingTools = [
    h("label.tool", [background, "focus and poses"]),
    zoom("Smaller", "−", () => drawing.viewport.zoom(0.8)),
    zoom("Larger", "+", () => drawing.viewport.zoom(1.25)),
    zoom("Show all", "⤢", () => drawing.viewport.fit()),
  ];
  host.tools.append(...drawingTools, switcher);
  show(chosen ?? "drawing");
  const resizing = new ResizeObserver(() => show(shown()));
  resizing.observe(element);

  const off = server.onState((state) => {
    drawing.update(state);
    if (shown() === "tables") tables.update(state);
    for (const [name, view] of views) {
      if (name in state.focus) continue;
      view.close();
      view.element.remove();
      views.delete(name);
    }
    for (const name of Object.keys(state.focus)) {
      if (views.has(name)) continue;
      const view = new WorkspaceView(server, name);
      views.set(name, view);
      workspaces.append(view.element);
    }
  });
  return {
    element,
    close: () => {
      off();
      resizing.disconnect();
      drawing.close();
      for (const view of views.values()) view.close();
    },
  };
};
