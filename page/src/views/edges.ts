// SPDX-License-Identifier: Apache-2.0
import { numbersOf, type Message } from "../mtp";

export interface Edge {
  readonly from: number;
  readonly to: number;
  /** Empty: the graph has none. */
  readonly weights: readonly number[];
}

export interface Network {
  readonly nodes: number;
  readonly edges: readonly Edge[];
}

/** The nodes and edges of a dense or sparse graph (R45). */
export function networkOf(message: Message): Network {
  const { type, width, height, components } = message.header;
  const numbers = numbersOf(message);
  const weightsAt = (from: number, to: number) => Array.from(numbers.subarray(from, to));
  const edges: Edge[] = [];
  if (type === "dense_graph") {
    for (let element = 0; element < width * height; ++element) {
      const weights = weightsAt(element * components, (element + 1) * components);
      if (weights.every((weight) => weight === 0)) continue;
      edges.push({ from: Math.floor(element / width), to: element % width, weights });
    }
    return { nodes: width, edges };
  }
  let nodes = 0;
  for (let at = 0; at + components <= numbers.length; at += components) {
    const [from, to] = [numbers[at]!, numbers[at + 1]!];
    nodes = Math.max(nodes, from + 1, to + 1);
    const weights = weightsAt(at + 2, at + components);
    // A row with only zero weights declares a node.
    const isNode = from === to && weights.length > 0 && weights.every((weight) => weight === 0);
    if (!isNode) edges.push({ from, to, weights });
  }
  return { nodes, edges };
}
