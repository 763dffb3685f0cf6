#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Each module of a graph of images is killed again and again, while images flow."""

import os
import signal
import time
import unittest

from endurance import Endurance, IMAGES, IS_FULL, quantile, report

KILLS = 100 if IS_FULL else 2  # of each module
BETWEEN = 2.6  # of the same module: five starts within 10 s are not put off (G40) [s]


class ModuleKills(Endurance):
    def test_messages_flow_again_and_none_is_damaged(self):
        process = self.begin(IMAGES)
        observed = self.observed(process)
        self.state(observed, self.all_run)
        for name in ("near", "far"):
            self.await_message(name, 0)
        names = ("camera", "relay", "near", "far")
        killed = dict.fromkeys(names, 0)
        ready, first, gone = ({name: [] for name in names} for _ in range(3))
        for _ in range(KILLS):
            for name in names:
                if IS_FULL:
                    time.sleep(max(0, killed[name] + BETWEEN - time.monotonic()))
                # Not one of the states that were sent while nobody read them.
                with self.observing(process) as fresh:
                    state = self.state(fresh, self.all_run)
                    before = self.module(state, name)["pid"]
                    killed[name] = time.monotonic()
                    os.kill(before, signal.SIGKILL)
                    is_back = lambda state: self.all_run(state) and (
                        self.module(state, name)["pid"] not in (0, before)
                    )
                    self.state(fresh, is_back)
                is_ready = time.monotonic()
                came = max(self.await_message(each, is_ready) for each in ("near", "far"))
                ready[name].append(is_ready - killed[name])
                first[name].append(came - is_ready)
                gone[name].append(came - killed[name])
        self.halt(process)
        self.check_noted("near", "far")
        for name in names:
            report(
                "%s killed %d times: runs again after %.0f ms (at most %.0f); then the next "
                "message at each consumer within %.0f ms p99, %.0f at most; from the kill %.0f, %.0f",
                *(name, KILLS, 1e3 * quantile(ready[name], 0.5), 1e3 * max(ready[name])),
                *(1e3 * quantile(first[name], 0.99), 1e3 * max(first[name])),
                *(1e3 * quantile(gone[name], 0.99), 1e3 * max(gone[name])),
            )
        for other, name in (("far", "near"), ("near", "far")):
            times = [each[0] for each in self.noted(name)]
            gaps = [b - a for a, b in zip(times, times[1:])]
            report("%s: %d messages, longest gap %.0f ms", name, len(times), 1e3 * max(gaps))
        for name in names:
            self.limit(quantile(first[name], 0.99), 0.25, name)
            self.limit(max(first[name]), 1, name)


if __name__ == "__main__":
    unittest.main()
