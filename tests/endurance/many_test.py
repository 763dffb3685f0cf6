#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Many modules in one graph: how soon they all run, what they cost, and that nothing is left."""

import resource
import time
import unittest

from endurance import Endurance, IS_FULL, memory, processes_of, processor_time, ring, report

COUNT = 200 if IS_FULL else 20
RING = ring(["relay_%d" % i for i in range(COUNT)])
PERIOD = 10 if IS_FULL else 1  # for which processor time is measured [s]


class Many(Endurance):
    def cost(self, process):
        """Of hc run, and of one module with its guard: parts of a processor."""
        all_processes = processes_of(process.pid)
        others = [each for each in all_processes if each != process.pid]
        before = processor_time([process.pid]), processor_time(others)
        begun = time.monotonic()
        time.sleep(PERIOD)
        after = processor_time([process.pid]), processor_time(others)
        passed = time.monotonic() - begun
        self.assertEqual(sorted(all_processes), sorted(processes_of(process.pid)))
        return (after[0] - before[0]) / passed, (after[1] - before[1]) / passed / COUNT

    def test_they_start_cost_little_and_leave_nothing(self):
        begun = time.monotonic()
        process = self.begin(RING)
        with self.observing(process) as observed:
            self.state(observed, self.all_run)
            took = time.monotonic() - begun
            report("%d modules run after %.2f s", COUNT, took)
            self.limit(took, 5, "start")
            seen = self.cost(process)
        alone = self.cost(process)
        for what, (runner, module) in (("watched", seen), ("not watched", alone)):
            report("%s: hc run %.2f %%, a module %.3f %%", what, 100 * runner, 100 * module)
            self.limit(module, 0.001, what)
        modules = [each for each in processes_of(process.pid) if each != process.pid]
        report(
            "memory: hc run %.1f MB, a module with its guard %.2f MB",
            memory(process.pid) / 1e6,
            sum(map(memory, modules)) / COUNT / 1e6,
        )
        took = self.halt(process)
        report("all ended after %.2f s", took)
        self.assertEqual(processes_of(process.pid), [])

    def test_as_many_descriptors_as_a_login_shell_allows_are_enough(self):
        limits = resource.getrlimit(resource.RLIMIT_NOFILE)
        low = 1024 if IS_FULL else 128
        resource.setrlimit(resource.RLIMIT_NOFILE, (low, limits[1]))
        try:
            process = self.begin(RING)
        finally:
            resource.setrlimit(resource.RLIMIT_NOFILE, limits)
        self.state(self.observed(process), self.all_run)
        self.halt(process)


if __name__ == "__main__":
    unittest.main()
