// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { headerOf } from "../mtp";
import { bidsOf, type Bid } from "../server";
import { BidHistory, whyText } from "./bids";

const names = (mode: number): string =>
  ["none", "calibrate", "point", "tele", "track", "read"][mode]!;
const rules = { margin: 0.1, dwell: 1, stopped: false };

test("one sentence says why the winner wins", () => {
  const bid = (mode: number, salience: number, other: Partial<Bid> = {}): Bid => ({
    mode,
    salience,
    age: 0,
    inFocus: false,
    ofPerson: false,
    ...other,
  });
  const track = bid(4, 0.6, { inFocus: true });
  const why = (...bids: Bid[]): string => whyText(bids, rules, names);
  assert.equal(why(), "No task bids for the focus.");
  assert.equal(why(track), "track has the focus as the only bidder, with 0.60.");
  assert.equal(
    why(track, bid(5, 0.4)),
    "track has the focus: it bids 0.60, next is read with 0.40.",
  );
  assert.equal(
    why(track, bid(5, 0.65)),
    "track keeps the focus with 0.60: read with 0.65 does not exceed it by more than 0.1.",
  );
  assert.equal(
    why(track, bid(5, 0.9)),
    "track keeps the focus with 0.60 for its first 1 s; next is read with 0.90.",
  );
  assert.equal(
    why(bid(2, 0.5, { inFocus: true, ofPerson: true }), bid(4, 0.6)),
    "point has the focus: a person's bid overrides all others.",
  );
  assert.match(whyText([track], { ...rules, stopped: true }, names), /stopped/);
});

test("bids are read from standings, and kept for a while", () => {
  const kind = { type: "table", components: 1, scalar: "f64", encoding: "binary" } as const;
  const elements = Float64Array.from([4, 0.6, 0.05, 1, 0, 5, 0.4, 0.01, 0, 1]);
  const bids = bidsOf({ header: headerOf(kind, 5, 2), elements });
  assert.deepEqual(bids, [
    { mode: 4, salience: 0.6, age: 0.05, inFocus: true, ofPerson: false },
    { mode: 5, salience: 0.4, age: 0.01, inFocus: false, ofPerson: true },
  ]);
  const history = new BidHistory(60);
  history.add(0, bids);
  history.add(50, bids.slice(0, 1));
  history.add(70, bids.slice(0, 1));
  const times = () => history.of(4).map(({ time }) => time);
  assert.deepEqual(times(), [50, 70]);
  history.add(60, bids); // a replay went back
  assert.deepEqual(times(), [60]);
});
