// SPDX-License-Identifier: Apache-2.0
// The marks of a graph's drawing: nodes and links.
import { svg } from "../shell";
import { pathThrough } from "./labels";
import { stackOffset, type Box, type Line } from "./layout";
import type { Edge, Node } from "./structure";

const inset = 9; // of text in a node [px]
/** Where the tilt of a pose begins in a node: after "pan −180°", so that neither moves [px]. */
const tiltAt = 78;
const letter = { name: 7.8, detail: 6 }; // widths [px]

/** A text that fits into a node. */
export function shorten(text: string, width: number, of: keyof typeof letter): string {
  const letters = Math.floor((width - 2 * inset) / letter[of]);
  return text.length <= letters ? text : `${text.slice(0, letters - 1)}…`;
}

/** A target of pointer and keyboard. */
const item = { role: "button", tabindex: -1 };

export type NodeMark = ReturnType<typeof drawNode>;

/**
 * @param act  opens the part or its module.
 * @param close  closes the open part to which it belongs.
 */
export function drawNode(node: Node, box: Box, act: () => void, close: () => void) {
  const { width, height } = box;
  const [left, top] = [-width / 2, -height / 2];
  const isPart = node.members.length > 1;
  const title = svg("title");
  const up = node.pose ? 8 : 0; // makes room for the pose
  const detail = svg("text.node-detail", { x: left + inset, y: 13 - up });
  const [pan, tilt] = [svg("tspan", { x: left + inset }), svg("tspan", { x: left + tiltAt })];
  const pose = svg("text.node-pose", { y: 29 - up, display: "none" }, [pan, tilt]);
  const place = { x: left, y: top, width, height, rx: 8 };
  const name = shorten(node.label, width - (isPart ? 14 : 0), "name");
  const plus = `M${-left - 20} ${-8 - up}h8M${-left - 16} ${-12 - up}v8`;
  const group = svg(
    "g.node",
    {
      ...item,
      "data-members": node.members.join(" "),
      "aria-expanded": isPart ? "false" : null,
      onclick: act,
    },
    [
      title,
      isPart && svg("rect.node-box", { ...place, x: left + stackOffset, y: top + stackOffset }),
      svg("rect.node-box", place),
      svg("text.node-name", { x: left + inset, y: -4 - up }, name),
      detail,
      node.pose !== "" && pose,
      isPart && svg("path.node-more", { d: plus }),
    ],
  );
  const text = shorten(node.part ? `− ${node.caption}` : node.caption, width + 10, "name");
  const caption = svg(
    "g.caption",
    node.part ? { ...item, "aria-expanded": "true", onclick: close } : {},
    svg("text.caption-text", { x: left + 2, y: top - 5 }, text),
  );
  const element = svg("g", { transform: `translate(${box.x} ${box.y})` }, [
    node.caption && caption,
    group,
  ]);
  return { element, group, caption, title, detail, pose, pan, tilt, box, node };
}

export type EdgeMark = ReturnType<typeof drawEdge>;

export function drawEdge(edge: Edge, { points, label }: Line, act: () => void) {
  const d = pathThrough(points);
  const title = svg("title");
  const rate = svg("tspan.edge-rate");
  const age = svg("tspan.edge-age");
  const group = svg("g.edge", { ...item, "data-edge": edge.key, onclick: act }, [
    title,
    svg("path.edge-line", { d, "marker-end": "url(#arrow)" }),
    svg("path.edge-hit", { d }),
  ]);
  // Above all lines.
  const at = label && { x: label.x, y: label.y, "text-anchor": label.anchor };
  const words = svg("text.edge-words", at ?? {}, label && [rate, age]);
  return { group, words, title, rate, age, edge, at: points[0]! };
}
