// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { GraphLink, GraphModule, GraphState, Session } from "../server";
import { stoppedBy, taskOf, whoText, type Situation } from "./who";

const link = (from: string, to: string): GraphLink => ({ from, to }) as GraphLink;
const module = (name: string, mode = ""): GraphModule => ({ name, mode }) as GraphModule;

test("an output's task is that of the module that reads it", () => {
  const state = {
    links: [
      link("web.stick", "log.in"),
      link("web.stick", "point.stick"),
      link("web.rotation", "telepresence.setpoint"),
      link("other.target", "track.target"),
      link("web.text", "speak.text"),
      link("web.hold", "attend.hold"),
      link("attend.target", "attend_gaze.target"),
    ],
    modules: [
      module("log"),
      module("point", "point"),
      module("telepresence", "telepresence"),
      module("track", "track"),
      module("speak"),
      module("attend"),
      module("attend_gaze", "attend"),
    ],
    modes: { point: 2, telepresence: 3, track: 4, attend: 6 },
  } as unknown as GraphState;
  assert.equal(taskOf(state, "web", "stick"), 2);
  assert.equal(taskOf(state, "web", "rotation"), 3);
  assert.equal(taskOf(state, "web", "target"), 0);
  assert.equal(taskOf(state, "web", "text"), 0);
  assert.equal(taskOf(state, "web", "hold"), 6);
  assert.equal(taskOf(state, "page", "stick"), 0);
});

test("a stop names its sources, known ones in words", () => {
  const state = {
    modules: [
      { name: "hands", program: "hands" },
      { name: "page", program: "/usr/lib/hypercolumn/web" },
    ],
    stopped_by: { left: ["hands.stop"], right: ["page.stop", "hands.stop", "source 12"] },
  } as unknown as GraphState;
  assert.equal(stoppedBy(state), "by an open palm (hands.stop), a page (page.stop), source 12");
  assert.equal(stoppedBy({ ...state, stopped_by: {} }), "");
  assert.equal(stoppedBy(undefined), "");
});

const session = (more: Partial<Session> = {}): Session =>
  ({ right: "operate", driver: null, stopped: false, ...more }) as Session;
const text = (more: Partial<Situation> = {}): string =>
  whoText({
    connection: { status: "open" },
    session: session({ driver: "other" }),
    seat: "held",
    lost: "",
    slow: false,
    decides: true,
    focus: ["point"],
    bid: "point",
    fresh: false,
    ...more,
  });

test("the words for who has the head are those of the workspace", () => {
  assert.equal(text(), "You hold the head (point).");
  assert.equal(text({ focus: ["track"] }), "You do not hold the head: track has it.");
  assert.equal(text({ focus: ["track"], fresh: true }), "Taking the head (point)…");
  assert.equal(text({ focus: [] }), "You do not hold the head: no task has it.");
  assert.equal(text({ bid: "", focus: ["track"] }), "The robot decides: track.");
  assert.equal(text({ session: session({ stopped: true }) }), "Stopped. You have the seat.");
  assert.equal(
    text({ session: session({ stopped: null }), focus: [] }),
    "You do not hold the head: the workspace does not answer.",
  );
  assert.equal(text({ decides: false, focus: [] }), "You have the seat.");
  const tooSlow = "This page is too slow to drive: close other tabs.";
  assert.equal(text({ slow: true, focus: ["track"] }), `${tooSlow} In focus: track.`);
  assert.equal(text({ slow: true, decides: false }), tooSlow);
});

test("who does not have the seat reads who does", () => {
  const free = { seat: "free", bid: "" } as const;
  assert.equal(text({ ...free, session: session() }), "The robot decides: point.");
  assert.equal(text(free), "Somebody else has the seat. In focus: point.");
  assert.equal(text({ ...free, session: session({ stopped: true }) }), "Stopped.");
  assert.equal(
    text({ ...free, session: session({ right: "view" }) }),
    "The robot decides: point. You may only look; to drive, ask for another URL.",
  );
  const lost = { ...free, seat: "lost", lost: "It was taken.", session: session() } as const;
  assert.equal(text(lost), "It was taken. The robot decides: point.");
});

test("without a graph or a connection no task has the head", () => {
  const lost = { status: "lost", why: "", retry: 1, ended: false } as const;
  assert.match(text({ connection: lost, seat: "free" }), /^No connection: it is unknown/);
  const connection = { ...lost, retry: null, ended: true };
  assert.equal(text({ connection }), "The graph has ended.");
});
