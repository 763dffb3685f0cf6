// SPDX-License-Identifier: Apache-2.0
import { bidHelp, BidRows } from "../bids/rows";
import { bidsOf, modeName } from "../server";
import { h } from "../shell/h";
import type { ViewKind } from "./view";

/** Bids for the focus, the default view of a table that declares modes and their salience. */
export const barsView: ViewKind = {
  name: "bars",
  fits: ({ type }, { columns }) =>
    type === "table" && columns[0] === "mode" && columns[1] === "salience",
  make: async ({ surroundings }) => {
    await surroundings.ready();
    const { state } = surroundings;
    const rows = new BidRows((mode) => modeName(state, mode));
    rows.addModes(Object.values(state?.modes ?? {}));
    return {
      element: h("div.bids", rows.element),
      tools: [bidHelp()],
      show: ({ message, at }) => {
        const { time } = message.header;
        rows.take(bidsOf(message), time > 0n ? Number(time) / 1e9 : at / 1000);
      },
      close: () => rows.close(),
    };
  },
};
