// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { layoutOf, layoutText, type Layout } from "./layout";

const layout: Layout = [
  {
    share: 1.5,
    places: [
      { args: { kind: "stream", port: "head_eyes.left" }, share: 1 },
      { args: { kind: "stream", port: "a.b", note: "a|b;c,d*e=f g%" }, share: 0.25 },
    ],
  },
  { share: 1, places: [{ args: { kind: "graph" }, share: 1 }] },
];

test("a layout comes back from its text", () => {
  assert.deepEqual(layoutOf("#" + layoutText(layout)), layout);
});

test("the text is short enough to be read", () => {
  assert.equal(layoutText([layout[1]!]), "graph");
  assert.match(
    layoutText(layout),
    /^stream,port=head_eyes.left;stream,port=a.b,.*\*0.25\*\*1.5\|graph$/,
  );
});

test("what makes no sense is dropped", () => {
  assert.deepEqual(layoutOf(""), []);
  assert.deepEqual(layoutOf("#|;|,x=1"), []);
  assert.deepEqual(layoutOf("a,b=%zz|graph*-3"), [
    { share: 1, places: [{ args: { kind: "graph" }, share: 1 }] },
  ]);
});
