// SPDX-License-Identifier: Apache-2.0
import type { GraphState, Session } from "../server";
import type { Layout } from "./layout";
import type { PanelArgs } from "./panel";

/** The two eyes: outputs left and right of a module that has no such inputs. */
function eyesOf(state: GraphState): string[] {
  const outputs = new Set(state.links.map((link) => link.from));
  const pairs = state.modules
    .map(({ name }) => name)
    .filter((name) => outputs.has(`${name}.left`) && outputs.has(`${name}.right`));
  const isFed = (name: string) =>
    state.links.some(
      ({ from, to }) => to.startsWith(`${name}.`) && pairs.includes(from.split(".")[0]!),
    );
  const name = pairs.find((each) => !isFed(each));
  return name === undefined ? [] : [`${name}.left`, `${name}.right`];
}

/**
 * Both eyes, the graph and the seat, if present, in as many columns as fit the page.
 *
 * @param width  of the page [px].
 */
export function defaultLayout(state: GraphState, session: Session, width: number): Layout {
  const eyes = eyesOf(state).map((port): PanelArgs => ({ kind: "stream", port }));
  const graph: PanelArgs = { kind: "graph" };
  const seat: PanelArgs[] = session.drives.length > 0 ? [{ kind: "seat" }] : [];
  const column = (share: number, places: readonly PanelArgs[]) => ({
    share,
    places: places.map((args) => ({ args, share: args.kind === "seat" ? 1.4 : 1 })),
  });
  const columns =
    width < 700
      ? [column(1, [...eyes.slice(0, 1), ...seat, ...eyes.slice(1), graph])]
      : width < 1500
        ? [column(1, eyes), column(1.4, [...seat, graph])]
        : [column(1, eyes), column(1.6, [graph]), column(1, seat)];
  return columns.filter(({ places }) => places.length > 0);
}
