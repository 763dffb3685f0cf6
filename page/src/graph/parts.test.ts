// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { GraphState } from "../server";
import { columnsOf } from "./columns";
import { linkOf, moduleNamed, stateOf, stateOfFile } from "./graph_file";
import { layoutOf } from "./layout";
import { partsOf } from "./parts";
import { structureKey, structureOf } from "./structure";

/** Each part of several modules as "label: its modules", each other one as its label. */
function shownParts(state: GraphState): string[] {
  return partsOf(state).map(({ label, members }) =>
    members.length > 1 ? `${label}: ${members.join(" ")}` : label,
  );
}

/** Labels of the nodes of a drawing, by column. */
function shownColumns(state: GraphState, open: readonly string[] = []): string[] {
  const structure = structureOf(state, new Set(open));
  const columns = columnsOf(structure);
  return [...new Set(columns.values())]
    .sort((a, b) => a - b)
    .map((column) =>
      structure.nodes
        .filter(({ key }) => columns.get(key) === column)
        .map(({ label }) => label)
        .join(" "),
    );
}

const chain = stateOf(
  Array.from({ length: 30 }, (_, i) => moduleNamed(`stage_${i}`)),
  Array.from({ length: 29 }, (_, i) => linkOf(`stage_${i}.out`, `stage_${i + 1}.in`)),
);

test("the head is eyes, a ball, tasks, a neck, as a person thinks of it", () => {
  assert.deepEqual(shownParts(stateOfFile("head.toml")), [
    "eyes",
    "hearing",
    "mouth",
    "neck: head_neck head_unit",
    "workspace",
    "person: web joystick head_tracker",
    "rectify",
    "depth",
    "viewers: view_left view_depth augment view_augmented",
    "calibrate",
    "point",
    "telepresence",
    "ball ×2: left_ball right_ball",
    "track",
    "faces",
    "attend: attend attend_gaze",
    "hands",
    "follow_finger",
    "read: read read_gaze",
    "speak",
  ]);
});

for (const [file, parts] of [
  ["real_head.toml", ["eyes", "neck", "ears", "hearing", "mouth"]],
  ["depth.toml", ["camera", "depth", "truth", "depth_score", "view"]],
  ["fleet_watch.toml", ["brightness", "view"]],
  ["pipeline.toml", ["camera", "rectify", "depth", "marker", "augment", "view"]],
  ["clocked_track.toml", ["eyes", "ball", "track", "track_score"]],
] as const) {
  test(`parts of ${file}`, () => assert.deepEqual(shownParts(stateOfFile(file)), parts));
}

test("what nothing reads is a viewer, but not what a task commands", () => {
  const modules = [
    moduleNamed("look", { mode: "look" }),
    ...["neck", "view", "log"].map((name) => moduleNamed(name)),
  ];
  const links = [linkOf("look.command", "neck.command"), linkOf("neck.pose", "view.pose")];
  const state = { ...stateOf(modules, links), modes: { look: 1 } };
  assert.deepEqual(shownParts(state), ["look", "neck", "viewers: view log"]);
  const withoutView = { ...state, links: links.slice(0, 1) };
  assert.ok(shownParts(withoutView).includes("neck"));
});

test("a module that only an included graph's own modules read belongs to one of them", () => {
  const state = stateOfFile("track_marker.toml");
  const neck = partsOf(state).find(({ label }) => label === "neck")!;
  assert.deepEqual([neck.members, neck.body], [["head_neck", "head_unit"], "head"]);
});

test("a head within a graph that another one includes has the same parts", () => {
  const head = stateOfFile("head.toml");
  const within = (name: string): string => (name === "" ? "robot" : `robot_${name}`);
  const robot = {
    ...head,
    focus: Object.fromEntries(Object.entries(head.focus).map(([name, at]) => [within(name), at])),
    modules: head.modules.map((module) => ({
      ...module,
      name: within(module.name),
      group: within(module.group),
      workspace: module.workspace && within(module.workspace),
    })),
    links: head.links.map((link) => ({ ...link, from: within(link.from), to: within(link.to) })),
  };
  const labels = (state: GraphState) =>
    partsOf(state).map(({ label, members }) => [label, members.length]);
  assert.deepEqual(labels(robot), labels(head));
});

test("a long run is one part between its ends", () => {
  assert.deepEqual(
    partsOf(chain).map(({ label }) => label),
    ["stage_0", "stage_1 … stage_28", "stage_29"],
  );
});

test("a recorder of everything is a viewer, and changes no other part", () => {
  const state = stateOfFile("head.toml");
  const outputs = [...new Set(state.links.map(({ from }) => from))];
  const recorded = {
    ...state,
    modules: [...state.modules, moduleNamed("recorder")],
    links: [...state.links, ...outputs.map((from) => linkOf(from, "recorder.in"))],
  };
  const added = "viewers: view_left view_depth augment view_augmented";
  assert.deepEqual(
    shownParts(recorded),
    shownParts(state).map((part) => (part === added ? `${added} recorder` : part)),
  );
});

test("data flows from the eyes over tasks of one column to what they move", () => {
  assert.deepEqual(shownColumns(stateOfFile("head.toml")), [
    "eyes",
    "hearing person rectify ball ×2",
    "depth faces",
    "viewers hands",
    "calibrate point telepresence track attend follow_finger read",
    "neck workspace speak",
    "mouth",
  ]);
  assert.deepEqual(shownColumns(stateOfFile("clocked_track.toml")), [
    "eyes",
    "ball track_score",
    "track",
  ]);
});

test("the columns of the others stay where a part opens", () => {
  const state = stateOfFile("head.toml");
  assert.deepEqual(shownColumns(state, ["head_neck:", "person:"]), [
    "eyes",
    "hearing web rectify ball ×2",
    "depth faces",
    "joystick head_tracker viewers hands",
    "head_unit calibrate point telepresence track attend follow_finger read",
    "head_neck workspace speak",
    "mouth",
  ]);
});

test("an open part shows its modules, and the place outside from which images come is a node", () => {
  assert.deepEqual(shownColumns(stateOfFile("fleet_watch.toml")), [
    "dds:robot/camera",
    "brightness view",
  ]);
  const nodes = structureOf(stateOfFile("head.toml"), new Set(["task:read"])).nodes;
  assert.deepEqual(
    nodes.filter(({ part }) => part === "task:read").map(({ key, caption }) => [key, caption]),
    [
      ["read", "read"],
      ["read_gaze", "read"],
    ],
  );
});

test("neither focus nor rates move anything", () => {
  const state = stateOfFile("head.toml");
  const later = {
    ...state,
    uptime: 9,
    focus: { workspace: { mode: "read", number: 5 } },
    modules: state.modules.map((module) => ({ ...module, in_workspace: true, cpu: 1 })),
    links: state.links.map((link) => ({ ...link, per_second: 100, in_workspace: true })),
  };
  const none = new Set<string>();
  assert.equal(structureKey(later, none), structureKey(state, none));
  assert.deepEqual(layoutOf(structureOf(later, none)), layoutOf(structureOf(state, none)));
});

for (const file of ["head.toml", "pipeline.toml", "score_read.toml"]) {
  test(`nothing overlaps in ${file}, with all parts open and closed`, () => {
    const state = stateOfFile(file);
    const all = partsOf(state).map(({ key }) => key);
    for (const open of [new Set<string>(), new Set(all)]) {
      const boxes = [...layoutOf(structureOf(state, open)).nodes.values()];
      boxes.forEach((a, i) => {
        for (const b of boxes.slice(i + 1)) {
          const isApart =
            Math.abs(a.x - b.x) >= (a.width + b.width) / 2 ||
            Math.abs(a.y - b.y) >= (a.height + b.height) / 2;
          assert.ok(isApart);
        }
      });
    }
  });
}
