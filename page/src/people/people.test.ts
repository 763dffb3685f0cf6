// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { headerOf, textMessage, type Kind, type Message } from "../mtp";
import type { Output } from "../outputs";
import type { GraphLink } from "../server";
import { People, type PeopleHost } from "./people";
import { peoplePorts } from "./ports";
import { Recent } from "./recent";
import { attendedOf, facesOf, handsOf, isName, namesOf } from "./tables";

const kind: Kind = { type: "table", components: 1, scalar: "f64", encoding: "binary" };

function table(rows: readonly (readonly number[])[], coord = 9, time = 0n): Message {
  const header = headerOf(kind, rows[0]?.length ?? 0, rows.length, { coord, time });
  return { header, elements: Float64Array.from(rows.flat()) };
}

const counted = (count: number): number[] => Array.from({ length: count }, (_, i) => i + 1);
const face = [10, 20, 30, 40, 0.9, 7, 3, ...counted(12), 0, 0, 1, 0, 0];

const output = (port: string, type: string, columns: string[]): Output =>
  ({ port, type, kind: { type }, columns }) as unknown as Output;
const link = (from: string, to: string): GraphLink => ({ from, to }) as GraphLink;

const outputs = [
  output("finder.faces", "table", ["x [px]", "track"]),
  output("finder.names", "string", []),
  output("chooser.attended", "table", ["track", "person"]),
  output("other.attended", "table", ["track", "person"]),
  output("fingers.hands", "table", ["track", "side"]),
  output("second.faces", "table", ["x [px]", "track"]),
  output("cards.hands", "table", ["suit"]),
];
const links = [
  link("camera.right", "second.left"),
  link("eyes.left", "rectify.left"),
  link("rectify.left", "finder.left"),
  link("rectify.left", "fingers.image"),
  link("finder.faces", "chooser.faces"),
  link("second.faces", "other.faces"),
  link("rectify.left", "augment.left"),
];

test("rows of faces and hands; others are left out", () => {
  const [first, ...others] = facesOf(table([face, [NaN, ...face.slice(1)]]));
  assert.deepEqual(others, []);
  assert.deepEqual([first!.x, first!.height, first!.track, first!.person], [10, 40, 7, 3]);
  assert.equal(first!.points.length, 6);
  assert.deepEqual(first!.points[5], { x: 11, y: 12 });
  assert.deepEqual(facesOf(table([])), []);
  assert.deepEqual(facesOf(table([[1, 2, 3]])), []);
  assert.deepEqual(facesOf(textMessage("7")), []);
  const [hand, strange] = handsOf(
    table([
      [4, 1, 0.9, 5, ...counted(42)],
      [5, 0, 0.9, 77, ...counted(42)],
    ]),
  );
  assert.deepEqual([hand!.isRight, hand!.sign, hand!.points.length], [true, "thumb up", 21]);
  assert.equal(strange!.sign, "");
  assert.deepEqual(attendedOf(table([[7, 3, 1]])), { track: 7, reason: "speaks" });
  assert.equal(attendedOf(table([])), undefined);
});

test("names by their numbers, with spaces in them", () => {
  const names = namesOf(textMessage(["1 Ann", "12 Zoë van der Berg", "nobody", "3"]));
  assert.deepEqual(
    [...names],
    [
      [1, "Ann"],
      [12, "Zoë van der Berg"],
    ],
  );
  assert.equal(namesOf(textMessage("1 Ann\n2 Bob")).get(2), "Bob");
});

test("a name is that of a file, of at most 64 bytes", () => {
  for (const name of ["Ann", "Zoë van der Berg", "a.b", "ä".repeat(32)]) assert.ok(isName(name));
  for (const name of ["", ".Ann", "A/n", "A\nn", "A\u007f", "a".repeat(65), "ä".repeat(33)])
    assert.ok(!isName(name), name);
});

test("the outputs are those for the images of the same camera", () => {
  const found = {
    faces: "finder.faces",
    names: "finder.names",
    attended: "chooser.attended",
    hands: "fingers.hands",
  };
  for (const image of ["eyes.left", "rectify.left", "augment.left"])
    assert.deepEqual(peoplePorts(outputs, links, image), found);
  const second = peoplePorts(outputs, links, "camera.right");
  assert.equal(second.faces, "second.faces");
  assert.equal(second.hands, undefined);
  assert.equal(peoplePorts(outputs, links, "elsewhere.left").faces, undefined);
  assert.equal(peoplePorts(outputs, undefined, "eyes.left").faces, "finder.faces");
  // Modules that feed each other have no origin.
  const ring = [link("a.left", "b.left"), link("b.left", "a.left")];
  assert.equal(peoplePorts(outputs, ring, "a.left").faces, undefined);
});

test("rows belong to the image of the nearest time, for a second", () => {
  const recent = new Recent<{ time: bigint }>();
  assert.equal(recent.at(0n), undefined);
  for (const time of [1_000_000_000n, 1_100_000_000n]) recent.push({ time });
  assert.equal(recent.at(1_040_000_000n)?.time, 1_000_000_000n);
  assert.equal(recent.at(2_100_000_000n)?.time, 1_100_000_000n);
  assert.equal(recent.at(2_100_000_001n), undefined);
});

test("outputs that are not known yet are asked for again, but not at once", async (t) => {
  let now = 10_000;
  t.mock.method(performance, "now", () => now);
  const unknown = { port: "finder.faces", type: "", doc: "", columns: [] };
  const answers = [Promise.reject(new Error("busy")), Promise.resolve([unknown])];
  let asked = 0;
  const host = {
    state: { modules: [], links },
    outputs: () => answers[asked++] ?? Promise.resolve(outputs),
    open: () => ({ on: () => undefined, close: () => undefined }),
  };
  const people = new People(host as unknown as PeopleHost);
  const follow = async (): Promise<void> => {
    people.follow("rectify.left");
    await new Promise(setImmediate);
  };
  for (let times = 1; times <= 3; ++times) {
    await follow();
    await follow();
    assert.deepEqual([asked, people.findsFaces], [times, times === 3]);
    now += 2000;
  }
  await follow();
  assert.equal(asked, 3, "all are known");
});

test("people in an image: in its coordinates, until the rows end", async () => {
  const senders = new Map<string, (message: Message) => void>();
  const host = {
    state: { modules: [], links },
    outputs: () => Promise.resolve(outputs),
    open: (port: string) => ({
      on: (_: string, take: (arrival: { message: Message }) => void) => {
        senders.set(port, (message) => take({ message }));
      },
      close: () => senders.delete(port),
    }),
  };
  const people = new People(host as unknown as PeopleHost);
  people.follow("rectify.left");
  await new Promise(setImmediate);
  const send = (port: string, message: Message): void => senders.get(port)!(message);
  const time = 5_000_000_000n;
  send("finder.faces", table([face], 9, time));
  assert.equal(people.at(time, 9).people[0]!.name, "person 3");
  assert.equal(people.at(time, 7).people.length, 1);
  assert.equal(people.at(time, 8).people.length, 0);
  send("finder.names", textMessage("3 Ann"));
  send("chooser.attended", table([[7, 3, 2]], 9, time));
  const [{ name, reason } = { name: "", reason: "" }] = people.at(time, 9).people;
  assert.deepEqual([name, reason], ["Ann", "held"]);
  assert.equal(people.seen().length, 1);
  send("finder.faces", table([], 9, time + 50_000_000n));
  assert.deepEqual(people.at(time + 50_000_000n, 9).people, []);
  assert.deepEqual(people.seen(), []);
  people.close();
  assert.equal(senders.size, 0);
});
