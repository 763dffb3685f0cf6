#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The wall clock is put forward, back and to 1970: it stamps messages, and steers nothing."""

import os
import socket
import time
import unittest

from endurance import BUILD, CHECKER, Endurance, IMAGES, IS_FULL, report
from harness import wait_until

HOUR = 3600
PERIOD = 5 if IS_FULL else 0.5  # between two steps [s]
LIMITED = 10  # messages a second that one link lets through
GRAPH = (
    IMAGES.rstrip()
    + """
keep = "latest"
rate = %d
[modules.failing]
program = "%s"
parameters = { fails = true }
"""
    % (LIMITED, CHECKER)
)


class WallClock(Endurance):
    def setUp(self):
        super().setUp()
        self.environment["WALL_CLOCK"] = self.path("clock")
        self.environment["LD_PRELOAD"] = str(BUILD / "tests/wall_clock.so")
        self.step(0)

    def step(self, seconds):
        self.write("clock", str(seconds))

    @staticmethod
    def steps():
        to_1970 = 100 - int(time.time())
        return (0, HOUR, -HOUR, 0, to_1970, 0)

    def stamped(self, name):
        """How far from now the last message was stamped [s]."""
        return int(self.lines(name)[-1][3]) / 1e9 - time.time()

    def test_a_graph_continues_whatever_the_clock_says(self):
        started = time.monotonic()
        process = self.begin(GRAPH)
        observed = self.observed(process)
        ready = lambda state: self.all_run({"modules": state["modules"][:4]})
        first = self.state(observed, ready)
        begun = time.monotonic()
        rates = []
        for seconds in self.steps():
            self.step(seconds)
            stepped = time.monotonic()
            time.sleep(PERIOD)
            ended = time.monotonic()
            for name in ("near", "far"):
                self.await_message(name, ended)
                # Some that were stamped before may still be on their way.
                wait_until(lambda: abs(self.stamped(name) - seconds) < HOUR / 2)
            count = lambda name: sum(stepped < each[0] <= ended for each in self.noted(name))
            rates.append([count(name) / (ended - stepped) for name in ("near", "far")])
        with self.observing(process) as fresh:
            state = self.state(fresh, ready)
        passed = time.monotonic() - begun
        for module in state["modules"][:4]:
            self.assertEqual(module["restarts"], 0, module)
        failing = self.module(state, "failing")
        self.assertGreater(failing["restarts"], 4)
        self.assertEqual(self.ask(process, "remove failing"), ["ok"])  # it may be given up by now
        self.halt(process)
        self.check_noted("near", "far")
        self.assertNotIn("stalled", self.said())
        report(
            "steps of %s s: messages a second %s; uptime %.2f s after %.2f s; %d restarts of one "
            "that fails, %s",
            ", ".join("%+d" % seconds for seconds in self.steps()),
            ", ".join("%.1f and %.1f" % tuple(pair) for pair in rates),
            *(state["uptime"] - first["uptime"], passed, failing["restarts"], failing["status"]),
        )
        self.limit(abs(state["uptime"] - first["uptime"] - passed), 0.6, "uptime")
        for near, far in rates:
            self.limit(abs(near / rates[0][0] - 1), 0.05, "rate")
            self.limit(abs(far / LIMITED - 1), 0.15, "limited rate")
        # Five starts at once, and then 0.1, 0.2, 0.4 … s, of which at least a half is waited.
        restarts, least = 4, 0.0
        while least <= time.monotonic() - started and restarts < 12:
            least += 0.05 * 2 ** (restarts - 4)
            restarts += 1
        self.assertLessEqual(failing["restarts"], restarts)
        most = sum(0.1 * 2**i for i in range(max(0, failing["restarts"] - 3)))
        if IS_FULL and failing["status"] == "waiting":
            self.assertLess(passed, most + 2)

    def test_a_wish_ends_though_the_clock_was_set_back(self):
        self.start(
            "exec hc gaze --mode 1 --timeout 1 --in setpoint=unix-listen:link --out bid=file:bids"
        )
        link = socket.socket(socket.AF_UNIX)
        self.addCleanup(link.close)
        wait_until(lambda: link.connect_ex(self.path("link")) == 0)
        bids = lambda: self.read("bids").split("\n")[1:-1:2]  # of rows that are whole
        wait_until(lambda: os.path.exists(self.path("bids")))
        link.sendall(b"1 1 0 0 8 0 20390 0 13 1 1\n0 0 1\n")
        wait_until(lambda: bids()[-1:] == ["0.5"])
        self.step(-HOUR)
        wait_until(lambda: bids()[-1] == "0")

    def test_a_recording_is_played_at_its_own_speed(self):
        count, apart = (100 if IS_FULL else 10), 0.1
        row = "1 1 0 %d 8 %d 60101 0 0 1 1\nx\n"
        text = "".join(row % (i, 10**18 + i * apart * 1e9) for i in range(count))
        self.write("in.mtp", text)
        process = self.start("exec hc play in.mtp")
        steps, late, begun = list(self.steps()), [], 0
        for number in range(count):
            self.assertIn(b" 60101 ", process.stdout.readline())
            process.stdout.readline()
            begun = begun or time.monotonic()
            late.append(time.monotonic() - begun - number * apart)
            if number % (count // 5) == 1:
                self.step(steps[number * 5 // count + 1])
        self.assertEqual(process.wait(), 0)
        earliest, latest = 1e3 * min(late), 1e3 * max(late)
        report("played: messages came between %.0f and %.0f ms late", earliest, latest)
        self.limit(max(map(abs, late)), 0.05, "play")


if __name__ == "__main__":
    unittest.main()
