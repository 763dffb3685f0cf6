#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Clocks of hosts that differ, are set, and run at different speeds. Needs root.

    clocks_test.py BUILD_FOLDER [TEST …]

HC_FULL=1 compares for a minute, and holds all to the times that doc/hosts.md promises.
"""

import statistics
import time
import unittest

from hosts import BRIGHTNESS, BUILD, CAMERA, FULL, HC, HostsTest, WATCHDOG, wait_until
from recordings import read_messages

# Until a clock that was set is logged [s].
TO_NOTICE = 1 if FULL else WATCHDOG
MOMENTS = 3000 if FULL else 300  # messages that are compared
DRIFTS = (100e-6, -100e-6)  # of the two hosts
GRAPH = """
[frames.moving]
parent = "robot"
moved_by = "fast.pose"
[modules.fast]
host = "h1"
program = "{moments}"
parameters = {{ start = {start} }}
[modules.slow]
host = "h2"
program = "{moments}"
inputs.in = "fast.moment"
[modules.here]
program = "{moments}"
inputs.in = "slow.moment"
[modules.whereabouts]
program = "{whereabouts}"
parameters = {{ target = "robot", source = "moving" }}
inputs.when = "slow.moment"
outputs.pose = {{ to = "file:{poses}", keep = "all" }}
"""
KEPT = """
[modules.{name}]
program = "relay"
inputs.in = {{ from = "{output}", keep = "all" }}
outputs.out = {{ to = "file:{file}", keep = "all" }}
"""


class Clocks(HostsTest):
    def test_clocks_that_differ_by_an_hour(self):
        (host,) = self.network.add()
        self.write("offset", "0")
        program = self.with_clock("shifted_hc", "WALL_CLOCK=" + self.path("offset"))
        graph = (
            CAMERA % "h1"
            + BRIGHTNESS % 'host = "h1"\n'
            + "[modules.here]\nprogram = 'brightness'\n"
        )
        self.write_graph(
            self.network.table(host, program) + graph + 'inputs.image = "camera.left"\n'
        )
        for hours in (1, -1):
            self.write("offset", str(3600 * hours))
            begin = time.time()
            kept = "kept_of_%d" % hours
            process = self.run_graph("--record " + kept, "here: started")
            messages = self.observe(process)
            state = self.state(
                messages,
                lambda state: self.rate(state, "camera.left", "here.image") and self.is_sure(state),
            )
            sure = time.time()
            self.clock_is(state, 3600 * hours)
            self.ages_are_right(messages)
            # A clock that is set while the graph runs changes no time of a message.
            self.write("offset", "7200")
            began = time.monotonic()
            self.await_lines(process, "host h1: its clock was set by %d" % (7200 - 3600 * hours))
            self.assertLess(time.monotonic() - began, TO_NOTICE)
            self.ages_are_right(messages)
            state = self.state(
                messages, lambda s: abs(s["hosts"][0]["offset"]) > 7000 and self.is_sure(s)
            )
            self.clock_is(state, 7200)
            self.stop(process)
            recorded = [
                each.time / 1e9 for each in read_messages(self.path(kept + "/camera.left.mtp"))
            ]
            self.assertGreater(len(recorded), 10)
            after = [each for each in recorded if each > sure]  # before, the clock may be corrected
            self.assertEqual(after, sorted(after))
            self.assertGreater(recorded[0], begin - 0.002)
            self.assertLess(recorded[-1], time.time() + 0.002)

    @staticmethod
    def is_sure(state):
        """Whether a message has come and gone without a wait for a processor."""
        return state["hosts"][0]["error"] < 0.1

    def clock_is(self, state, offset):
        host = state["hosts"][0]
        self.assertLess(abs(host["offset"] - offset), 0.001 + host["error"], host)

    def ages_are_right(self, messages):
        for _ in range(4):
            state = self.state(messages)
            for link in state["links"]:
                if link["age"]:
                    self.assertGreater(link["age"][0], -0.002, link)
                    self.assertLess(link["age"][0], 60, link)

    def with_clock(self, name, setting):
        """A `hc` whose host has another clock."""
        library = BUILD / "tests/wall_clock.so"
        text = '#!/bin/sh\nexport %s LD_PRELOAD=%s\nexec %s "$@"\n'
        return self.write_program(name, text % (setting, library, HC))

    def test_clocks_that_drift(self):
        """One runs faster by 100 ppm and one slower: it is known, and no time of a message shows it."""
        hosts = self.network.add(2)
        since, start = time.monotonic_ns(), time.time()
        tables = ""
        for host, drift in zip(hosts, DRIFTS):
            setting = "CLOCK_DRIFT='%.0f %d'" % (drift * 1e6, since)
            program = self.with_clock(host.name + "_hc", setting)
            tables += self.network.table(host, program)
        text = GRAPH.format(
            moments=BUILD / "tests/moments",
            whereabouts=BUILD / "tests/whereabouts",
            start=start,
            poses=self.path("poses"),
        )
        outputs = {"poses_in": "fast.pose", "when": "slow.moment"}
        outputs.update({"ways_" + name: name + ".ways" for name in ("slow", "here")})
        for name, output in outputs.items():
            text += KEPT.format(name=name, output=output, file=self.path(name))
        process = self.running_graph(tables + text, "", "ways_here: started")
        messages = self.observe(process)
        states = [self.state(messages, self.is_whole)]
        while not (self.knows_drift if FULL else self.drifts_are_right)(states[-1]):
            states.append(self.state(messages, self.is_whole))
        for _ in range(40 if FULL else 8):
            states.append(self.state(messages, self.is_whole))
            passed = time.monotonic_ns() - since
            for each, ppm in zip(states[-1]["hosts"], DRIFTS):
                wrong = abs(each["offset"] - passed * 1e-9 * ppm)
                self.assertLess(wrong, 0.001 + (0 if FULL else each["error"]), each)
            if FULL:
                self.assertTrue(self.drifts_are_right(states[-1]), states[-1]["hosts"])
        lines = {"poses": 5, "when": 2, "ways_slow": 2, "ways_here": 2}  # of a message
        wait_until(lambda: all(self.read(f).count("\n") > n * MOMENTS for f, n in lines.items()))
        states += [self.state(messages, self.is_whole) for _ in range(5)]
        self.stop(process)
        self.times_are_right(start, states)

    @staticmethod
    def knows_drift(state):
        return all(each["drift"] for each in state["hosts"])

    @classmethod
    def drifts_are_right(cls, state):
        pairs = zip(state["hosts"], DRIFTS)
        return cls.knows_drift(state) and all(abs(e["drift"] - ppm) < 75e-6 for e, ppm in pairs)

    @staticmethod
    def is_whole(state):
        return len(state["hosts"]) == 2 and all(each["connected"] for each in state["hosts"])

    def times_are_right(self, start, states):
        # On a machine that is busy, what the hosts say of their own error may come to it.
        errors = [each["error"] for state in states for each in state["hosts"]]
        most = 0.002 + (0 if FULL else 2 * max(errors))
        moments = {t: rows[0][0] for t, rows in self.kept("when").items()}
        stamps = [t - moment for t, moment in moments.items()]
        self.assertGreater(len(stamps), 0.9 * MOMENTS)
        self.assertLess(max(map(abs, stamps)), most * 1e9)
        # Where the frame was at a moment is how long the truth has run then.
        found = self.kept("poses")
        self.assertGreater(len(found), 0.9 * MOMENTS)
        for t, rows in found.items():
            self.assertLess(abs(rows[0][3] - (moments[t] / 1e9 - start)), most)
        for name, link in (
            ("slow", ("fast.moment", "slow.in")),
            ("here", ("slow.moment", "here.in")),
        ):
            ways = [rows[0] for rows in self.kept("ways_" + name).values()]
            self.assertGreater(len(ways), 0.9 * MOMENTS)
            self.assertLess(max(abs(true - by_clocks) for true, by_clocks in ways), most * 1e9)
            true = statistics.median(each for each, _ in ways) / 1e9
            ages = [self.link(state, *link)["age"] for state in states]
            ages = [age[0] for age in ages if age]
            self.assertLess(abs(statistics.median(ages) - true), most)

    def kept(self, name):
        """Messages of a file, their rows of numbers, by their time."""
        return {each.time: each.rows for each in self.recorded(name)}


if __name__ == "__main__":
    unittest.main()
