#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A module that fails at once, again and again: what others notice."""

import time
import unittest

from endurance import CHECKER, Endurance, IMAGES, IS_FULL, processor_time, report

PERIOD = 10 if IS_FULL else 1  # [s]
FAILING = """
[modules.failing]
program = "%s"
parameters = { fails = true }
""" % (
    CHECKER
)


class Failing(Endurance):
    def rates(self, begun, ended):
        """Messages a second of each consumer between two moments."""
        passed = ended - begun
        return [
            sum(begun < each[0] <= ended for each in self.noted(name)) / passed
            for name in ("near", "far")
        ]

    def test_a_module_that_fails_at_once_costs_little(self):
        process = self.begin(IMAGES)
        observed = self.observed(process)
        self.state(observed, self.all_run)
        for name in ("near", "far"):
            self.await_message(name, 0)
        moments, used = [time.monotonic()], [processor_time([process.pid])]
        for period in range(2):
            if period == 1:
                self.write_graph(IMAGES + FAILING)
            time.sleep(PERIOD)
            moments.append(time.monotonic())
            used.append(processor_time([process.pid]))
        failing = lambda state: self.module(state, "failing")
        others = lambda state: [each for each in state["modules"] if each["name"] != "failing"]
        has_failed = lambda state: (
            failing(state)
            and failing(state)["restarts"] >= 5
            and self.all_run({"modules": others(state)})
        )
        state = self.state(observed, has_failed)
        for module in others(state):
            self.assertEqual(module["restarts"], 0, module)
        cpu = [(b - a) / (d - c) for a, b, c, d in zip(used, used[1:], moments, moments[1:])]
        rates = [self.rates(*pair) for pair in zip(moments, moments[1:])]
        report(
            "hc run %.2f %% before, %.2f %% with a module that fails at once; others %.1f and "
            "%.1f/s before, %.1f and %.1f/s then",
            *(100 * cpu[0], 100 * cpu[1], *rates[0], *rates[1]),
        )
        self.limit(cpu[1], 0.02, "processor")
        for before, then in zip(*rates):
            self.limit(abs(then / before - 1), 0.05, "rate")
        self.assertEqual(self.ask(process, "remove failing"), ["ok"])
        self.halt(process)
        self.check_noted("near", "far")


if __name__ == "__main__":
    unittest.main()
