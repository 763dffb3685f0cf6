// SPDX-License-Identifier: Apache-2.0
import { modeName, type GraphState } from "../server";
import { fill, h, type PanelKind } from "../shell";
import { bidHelp, BidRows } from "./rows";

/** The bids of all workspaces: {kind: "bids"}. */
export const bidsPanel: PanelKind = (_args, { server, setTitle, tools }) => {
  setTitle("Bids for the focus");
  tools.append(bidHelp());
  const none = h("p.empty.muted", "This graph has no workspace, so no tasks bid.");
  const element = h("div.bids", none);
  const rows = new Map<string, BidRows>();
  const close = () => {
    for (const each of rows.values()) each.close();
    rows.clear();
  };
  const show = (state: GraphState) => {
    const names = Object.keys(state.focus);
    if (names.join() !== [...rows.keys()].join()) {
      close();
      for (const name of names) rows.set(name, new BidRows((mode) => modeName(server.state, mode)));
      const sections = [...rows].map(([name, each]) =>
        h("section", { "aria-label": `Bids at ${name}` }, each.element),
      );
      fill(element, names.length > 0 ? sections : none);
    }
    for (const [name, each] of rows) each.addModes(modesOf(state, name));
  };
  const ends = [
    server.onState(show),
    server.standings.on(({ workspace, bids, at }) => rows.get(workspace)?.take(bids, at / 1000)),
    server.onConnection(({ status }) => {
      if (status !== "open") for (const each of rows.values()) each.clear();
    }),
    close,
  ];
  return { element, close: () => ends.forEach((end) => end()) };
};

/** The modes of the modules that obey a workspace. */
function modesOf(state: GraphState, workspace: string): number[] {
  const obeying = state.modules.filter((module) => module.workspace === workspace);
  return obeying.flatMap(({ mode }) => state.modes[mode] ?? []);
}
