// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { numbersMessage } from "../mtp";
import { Player } from "./player";
import { Track } from "./track";

/** A stream with a large message at each time, which contains the time. */
function track(port: string, times: readonly number[]): Track {
  const made = new Track(port, (index) =>
    Promise.resolve(numbersMessage("table", [times[index]!])),
  );
  for (const time of times) made.add(time, 1e6);
  return made;
}

/** Shown messages of a stream; each is shown until it is released. */
function shownOf(player: Player, port: string) {
  const source = player.open(port)!;
  const shown: number[] = [];
  let release = () => {};
  let arrived = () => {};
  source.on("message", ({ message }) => {
    shown.push(Number(message.elements[0]));
    arrived();
    return new Promise((resolve) => (release = resolve));
  });
  const next = () => new Promise<void>((resolve) => (arrived = resolve));
  return { source, shown, next, release: () => release() };
}

test("a stream that is still being shown goes to the newest time afterwards", async () => {
  const player = new Player([track("a.b", [100, 101, 102, 103])]);
  const { shown, next, release } = shownOf(player, "a.b");
  await next();
  player.goTo(101);
  player.goTo(103);
  player.goTo(102);
  const last = next();
  release();
  await last;
  assert.deepEqual(shown, [100, 102]);
});

test("before its first message a stream says so", async () => {
  const player = new Player([track("a.b", [105]), track("a.c", [100])]);
  const { source, shown, next, release } = shownOf(player, "a.b");
  const problems: string[] = [];
  const told = new Promise<void>((resolve) =>
    source.on("problem", (text) => {
      problems.push(text);
      if (problems.length === 2) resolve();
    }),
  );
  const arrived = next();
  player.goTo(105);
  await arrived;
  player.goTo(101);
  release();
  await told;
  assert.deepEqual(shown, [105]);
  assert.deepEqual(problems, ["", "The first message of this stream comes later."]);
});
