// SPDX-License-Identifier: Apache-2.0
// The texts of nodes and of the whole graph: the problem, or else the purpose. Pure.
import { moduleOf, type Bid, type GraphModule, type GraphState } from "../server";
import { linkKey, type Edge, type Node } from "./structure";
import { percentText, rateText, type Condition } from "./words";

export interface Saying {
  readonly is: Condition;
  readonly text: string;
}

/** A graph at one time, with its bids and conditions. */
export interface Now {
  readonly state: GraphState;
  /** The text of G31. */
  readonly frames: string;
  /** Whether the robot is stopped. */
  readonly stopped: boolean;
  readonly bids: (workspace: string) => readonly Bid[];
  readonly conditionOf: (module: GraphModule) => { is: Condition; why: string };
}

const order: readonly Condition[] = ["broken", "slow", "works", "ended"];

/** The text of a node. @param edges  those of the drawing. */
export function sayingOf(node: Node, edges: readonly Edge[], now: Now): Saying {
  const { state } = now;
  const members = state.modules.filter(({ name }) => node.members.includes(name));
  const conditions = members.map((module) => ({ module, ...now.conditionOf(module) }));
  const worst = order.find((each) => conditions.some(({ is }) => is === each)) ?? "works";
  const one = conditions.find(({ is }) => is === worst);
  if (one && worst !== "works") {
    const { name } = one.module;
    const isNamed = name === node.label || members.length === 1 || worst === "ended";
    const text = isNamed ? one.why : `${name}: ${one.why}`;
    return { is: worst, text };
  }
  return { is: "works", text: purposeText(node, members, edges, now) };
}

/** The purpose of a node, in the terms of its kind. */
function purposeText(
  node: Node,
  members: readonly GraphModule[],
  edges: readonly Edge[],
  now: Now,
): string {
  const { state } = now;
  // A task bids as a whole, a person too: which of its modules bids is in the links.
  switch (node.kind === "person" && node.part ? "module" : node.kind) {
    case "outside":
      return "outside of the graph";
    case "workspace": {
      if (now.stopped) return "stopped";
      const focus = state.focus[node.members[0]!];
      return focus ? `focus: ${focus.mode}` : "no task has the focus";
    }
    case "task": {
      const bid = bidOf(members[0], now);
      return bid ? `bids ${bid.salience.toFixed(2)}` : "no bid";
    }
    case "person": {
      const bids = Object.keys(state.focus).flatMap((workspace) => now.bids(workspace));
      const bid = bids.find(({ ofPerson }) => ofPerson);
      return bid ? `bids ${bid.salience.toFixed(2)}` : "no bid";
    }
    default: {
      const links = new Set(
        edges
          .filter((edge) => edge.from === node.key && !edge.background)
          .flatMap((edge) => edge.links),
      );
      const rates = state.links
        .filter((link) => links.has(linkKey(link)))
        .map((link) => link.per_second);
      const rate = rates.length > 0 ? rateText(Math.max(...rates)) || "silent" : "";
      const cpu = `cpu ${percentText(members.reduce((sum, each) => sum + each.cpu, 0))}`;
      return [rate, cpu].filter((text) => text !== "").join(" · ");
    }
  }
}

/** The bid of a task's module. */
function bidOf(module: GraphModule | undefined, now: Now): Bid | undefined {
  if (!module) return undefined;
  const number = now.state.modes[module.mode];
  return now.bids(module.workspace).find(({ mode }) => mode === number);
}

/** How many modules and messages there are, and which modules do not work. */
export function summaryOf(now: Now): { readonly counts: string; readonly problems: Saying } {
  const { modules, links } = now.state;
  const messages = links
    .filter(({ to }) => modules.some(({ name }) => name === moduleOf(to)))
    .reduce((sum, link) => sum + link.per_second, 0);
  const count = Math.round(messages).toLocaleString("en");
  const counts = `${modules.length} modules · ${count} messages/s`;
  const conditions = modules.map((module) => ({ module, ...now.conditionOf(module) }));
  const bad = conditions.filter(({ is }) => is === "broken" || is === "slow");
  if (conditions.every(({ is }) => is === "ended")) {
    return { counts, problems: { is: "ended", text: "all have ended" } };
  }
  const [first, ...others] = bad.sort((a, b) => order.indexOf(a.is) - order.indexOf(b.is));
  if (!first) return { counts, problems: { is: "works", text: "all work" } };
  const more = others.length > 0 ? `, and ${others.length} more` : "";
  return {
    counts,
    problems: { is: first.is, text: `${first.module.name}: ${first.why}${more}` },
  };
}
