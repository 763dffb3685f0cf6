#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""hc run is killed again and again: its modules end with it, and the next one starts."""

import os
import signal
import time
import unittest

from endurance import Endurance, IMAGES, IS_FULL, processes_of, quantile, report
from harness import wait_until

KILLS = 50 if IS_FULL else 3


class RunnerKills(Endurance):
    def test_all_modules_end_and_the_next_graph_starts(self):
        ended, started = [], []
        for _ in range(KILLS):
            begun = time.monotonic()
            process = self.begin(IMAGES)
            with self.observing(process) as observed:
                self.state(observed, self.all_run)
            for name in ("near", "far"):
                self.await_message(name, begun)
            started.append(time.monotonic() - begun)
            self.assertGreaterEqual(len(processes_of(process.pid)), 9)
            killed = time.monotonic()
            os.kill(process.pid, signal.SIGKILL)
            wait_until(lambda: not processes_of(process.pid))
            ended.append(time.monotonic() - killed)
            process.wait()
        self.check_noted("near", "far")
        report(
            "hc run killed %d times: all ended after %.0f ms, %.0f at most; the next graph's first "
            "messages after %.0f ms, %.0f at most",
            *(KILLS, 1e3 * quantile(ended, 0.5), 1e3 * max(ended)),
            *(1e3 * quantile(started, 0.5), 1e3 * max(started)),
        )
        self.limit(max(ended), 1, "end")


if __name__ == "__main__":
    unittest.main()
