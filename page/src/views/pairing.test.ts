// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { Pairing, type Side } from "./pairing";

interface Item {
  readonly time: bigint;
  readonly side: Side;
}

/** The pairs of items "l1", "r1", … as "1 1", and the dropped ones. */
function pairsOf(words: string): { pairs: string[]; dropped: string[] } {
  const pairs: string[] = [];
  const dropped: string[] = [];
  const pairing = new Pairing<Item>(({ side, time }) => dropped.push(`${side[0]}${time}`));
  for (const word of words.split(" ")) {
    const side = word[0] === "l" ? "left" : "right";
    const pair = pairing.take(side, { side, time: BigInt(word.slice(1)) });
    if (!pair) continue;
    assert.deepEqual([pair.left.side, pair.right.side], ["left", "right"]);
    pairs.push(`${pair.left.time} ${pair.right.time}`);
  }
  pairing.close();
  assert.equal(2 * pairs.length + dropped.length, words.split(" ").length); // none twice, none lost
  return { pairs, dropped };
}

test("images of one time are a pair, in whatever order they come", () => {
  assert.deepEqual(pairsOf("l1 r1 r2 l2 l3 l4 r3 r4").pairs, ["1 1", "2 2", "3 3", "4 4"]);
});

test("an image whose other one is missing is dropped, and an older one comes too late", () => {
  assert.deepEqual(pairsOf("l1 l2 r2 r1 l3 r3"), { pairs: ["2 2", "3 3"], dropped: ["l1", "r1"] });
});

const apart = (offset: number, period = 10): string =>
  Array.from({ length: 10 }, (_, i) => `l${period * i} r${period * i + offset}`).join(" ");

test("where the times of both are never the same, the nearest are pairs", () => {
  for (const offset of [3, 5, 7]) {
    const { pairs } = pairsOf(apart(offset));
    assert.ok(pairs.length >= 6, pairs.join(", "));
    for (const pair of pairs) {
      const [left = 0, right = 0] = pair.split(" ").map(Number);
      assert.ok(Math.abs(left - right) <= 5, pair);
    }
  }
});

test("times that are the same again are pairs again", () => {
  const { pairs } = pairsOf(`${apart(3)} l100 r100 l110 r110 l120 r120`);
  assert.deepEqual(pairs.slice(-3), ["100 100", "110 110", "120 120"]);
});

test("however irregular the times are, there are pairs", () => {
  const { pairs } = pairsOf(
    "l1 r40 l50 r120 l121 l200 r260 l330 r390 l420 r450 l500 r580 l640 r700",
  );
  assert.ok(pairs.length >= 2, pairs.join(", "));
});

test("an eye alone makes no pair, and few images are kept", () => {
  const { pairs, dropped } = pairsOf("l1 l2 l3 l4 l5 l6 l7");
  assert.deepEqual([pairs.length, dropped.length], [0, 7]);
});
