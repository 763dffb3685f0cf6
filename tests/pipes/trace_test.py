#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""hc trace: the parts of a path on a graph with known delays, running and recorded."""

import json
import statistics
import unittest

from graphs import Graphs
from harness import BUILD

PROGRAMS = "%s/tests/programs" % BUILD

# Each takes its time; the sum of it is what a message is old at the end.
GRAPH = """
[modules.source]
program = "{0}/bidder"
parameters = {{ script = "{1}", rate = 2 }}
[modules.first]
program = "{0}/delay"
parameters.seconds = 0.2
inputs.in = "source.command"
[modules.second]
program = "{0}/delay"
parameters.seconds = 0.1
inputs.in = "first.out"
[modules.last]
program = "{0}/delay"
inputs.in = "second.out"
"""

# A module without `control`.
SHELL = """#!/bin/bash
for word; do
  case $word in
  --describe)
    echo '{"inputs": [{"name": "in", "types": []}],
           "outputs": [{"name": "out", "types": [{"type": "table", "components": 1,
             "scalar": "f64", "width": 1, "height": 1, "coord": 0}]}],
           "parameters": []}'
    exit ;;
  in=*) in=${word#*=} ;;
  out=*) out=${word#*=} ;;
  esac
done
hc cat --raw "${in:--}" | hc play --speed max --out "${out:--}" /dev/stdin
"""


def graph(script="0:1 1000:end", text=GRAPH):
    return text.format(PROGRAMS, script)


class Tracing(Graphs):
    def trace_and_age(self, messages):
        """The path of last.in as hc trace has it, and the median age that hc top shows meanwhile."""
        tracing = self.start(
            "exec hc trace last.in --json --duration 4 --perfetto p.json --of " + self.name
        )
        ages = []
        while tracing.poll() is None:
            age = self.age(self.state(messages))
            if age is not None:
                ages.append(age)
        out, err = tracing.communicate()
        self.assertEqual(tracing.returncode, 0, err)
        traced = json.loads(out)
        self.assertGreaterEqual(traced["messages"], 3)
        path = traced["paths"][0]
        self.assertEqual(path["critical"], traced["messages"])
        return path, statistics.median(ages)

    def test_the_parts_add_up_to_the_age_that_top_shows(self):
        self.name, process = self.run_named("trace", graph(), "last: started")
        messages = self.observe(process, self.name)
        self.state(messages, lambda state: self.age(state) is not None)
        # Medians add up where the parts are alike from message to message: on a machine with more
        # work than it can do, not in each span of time.
        for attempt in range(8):
            path, age = self.trace_and_age(messages)
            parts = [
                step[part][0]
                for step in path["steps"]
                for part in ("link", "waiting", "processing")
                # In `last`, what comes after a message was taken is not in its age.
                if step["module"] != "last" or part == "link"
            ]
            if max(abs(sum(parts) - age), abs(path["age"][0] - age)) < 0.05 * age:
                break
        else:
            self.fail((parts, path, age))
        self.assertEqual(
            [(step["module"], step["in"], step["out"]) for step in path["steps"]],
            [("source", "", "command"), ("first", "in", "out"), ("second", "in", "out")]
            + [("last", "in", "")],
        )
        for step, least in zip(path["steps"], (0, 0.2, 0.1, 0)):
            self.assertGreaterEqual(step["processing"][0], least)
        events = json.loads(self.read("p.json"))["traceEvents"]
        names = {each["args"]["name"] for each in events if each["ph"] == "M"}
        self.assertEqual(names, {"source", "first", "second", "last"})
        self.assertGreater(len([each for each in events if each["ph"] == "f"]), 3)
        text = self.hc("trace last.in --duration 2 --of " + self.name)
        # At least 300 ms and 200 ms.
        self.assertRegex(
            text, r"^critical path of \d+ of \d+, ([3-9]\d\d|\d{4,}) ms old \(p99 \d+\)\n"
        )
        self.assertRegex(
            text,
            r"\n  first: in → out +[0-9.]+ +[0-9.]+ +[0-9.]+ +[0-9.]+ +([2-9]\d\d|\d{4,}) +\d+\n",
        )
        self.shell("hc trace last.out --of " + self.name, 2)
        self.assertIn('no linked port "last.out", did you mean', self.err)
        self.assertIn("or trace one of last.in\n", self.err)
        self.shell("hc trace", 2)
        self.assertNotIn("trace", self.stop(process)[1])

    @staticmethod
    def age(state):
        """At last.in, as hc top shows it; None where nothing came lately."""
        for link in state["links"]:
            if link["to"] == "last.in":
                return link["age"] and link["age"][0]

    def test_a_module_without_control_is_one_step(self):
        self.write("shell", SHELL, 0o755)
        text = graph().replace('program = "%s/delay"' % PROGRAMS, 'program = "./shell"', 1)
        text = text.replace("parameters.seconds = 0.2\n", "")
        self.name, process = self.run_named("trace", text, "last: started")
        messages = self.observe(process, self.name)
        self.state(messages, lambda state: self.age(state) is not None)
        traced = json.loads(self.hc("trace last.in --json --duration 3 --of " + self.name))
        steps = traced["paths"][0]["steps"]
        self.assertEqual(
            [(step["module"], step["outside"]) for step in steps],
            [("source", False), ("first", True), ("second", False), ("last", False)],
        )
        self.assertIn("(outside)", self.hc("trace last.in --duration 2 --of " + self.name))
        self.assertNotIn("trace", self.stop(process)[1])

    def test_a_recording_is_traced(self):
        self.write_graph(graph("0:1 4:end"))
        for kept in ("kept", "kept.mcap"):
            self.shell("hc run g.toml --quiet --record " + kept)
            traced = json.loads(self.shell("hc trace last.in --json --recording " + kept))
            self.assertGreaterEqual(traced["messages"], 3)
            path = traced["paths"][0]
            self.assertEqual(
                [step["module"] for step in path["steps"]], ["source", "first", "second", "last"]
            )
            self.assertGreaterEqual(path["age"][0], 0.3)
        self.assertRegex(self.shell("hc cat kept/last.trace.mtp"), "took in [0-9]+ [0-9]+ [0-9]+ ")
        self.shell("hc trace kept/last.trace.mtp", 2)
        self.assertIn("kept/last.trace.mtp has the messages of one stream", self.err)
        self.write("last.in", "")  # a file that has the name of a port
        self.shell("hc trace last.in --of none", 1)
        self.assertIn('no graph "none" is running', self.err)
        self.shell("hc trace nosuch.in --recording kept", 1)
        self.assertIn("nosuch sends no trace", self.err)
        self.shell("mkdir empty; hc trace last.in --recording empty", 1)
        self.assertIn("hc run --record writes them", self.err)
        # What a recorder that was killed has left is traced as far as it is whole.
        whole = self.read_bytes("kept.mcap")
        self.write("cut.mcap", whole[: len(whole) * 3 // 4])
        self.shell("hc trace first.in --json --recording cut.mcap")


if __name__ == "__main__":
    unittest.main()
