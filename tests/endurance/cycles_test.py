#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Graphs that are started and stopped again and again leave nothing behind. In a network of its
own, so that the sockets of others are not counted."""

import os
import pathlib
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "pipes"))

from namespaces import move_to_own_network  # noqa: E402

move_to_own_network()

from endurance import Endurance, IS_FULL, processes_of, ring, report  # noqa: E402
from harness import wait_until  # noqa: E402

COUNT, CYCLES = 10, 1000 if IS_FULL else 20
WARM = 10 if IS_FULL else 1  # cycles that are not counted
NAMES = ["relay_%d" % i for i in range(COUNT)]
RING = ring(NAMES)


def sockets():
    return len(pathlib.Path("/proc/net/unix").read_text().splitlines()) - 1


def shared_memory():
    """Of the whole machine [byte]."""
    text = pathlib.Path("/proc/meminfo").read_text()
    return int(text[text.index("Shmem:") :].split()[1]) << 10


def holdings(process):
    """The descriptors and threads of a process, and its memory that is nobody else's [kB]."""
    status = pathlib.Path("/proc/%d/status" % process).read_text()
    value = lambda key: int(status[status.index(key) :].split()[1])
    return len(os.listdir("/proc/%d/fd" % process)), value("Threads:"), value("RssAnon:")


class Cycles(Endurance):
    def settled(self, counted):
        """What is counted, once links that are being made are there."""
        seen = [counted()]

        def stays():
            time.sleep(0.5)
            seen.append(counted())
            return len(seen) > 3 and len(set(seen[-4:])) == 1

        wait_until(stays)
        return seen[-1]

    def test_graphs_that_end_leave_nothing(self):
        before = sockets(), shared_memory(), holdings(os.getpid())[:2]
        begun = time.monotonic()
        for _ in range(CYCLES):
            process = self.begin(RING)
            with self.observing(process) as observed:
                self.state(observed, self.all_run)
            self.halt(process)
            self.assertEqual(processes_of(process.pid), [])
            process.communicate()
        after = sockets(), shared_memory(), holdings(os.getpid())[:2]
        self.assertEqual((before[0], before[2]), (after[0], after[2]))
        report(
            "%d graphs of %d modules, %.0f ms each: %d sockets before, %d after; shared memory of "
            "the machine %+.1f MB",
            *(CYCLES, COUNT, (time.monotonic() - begun) / CYCLES * 1e3, before[0], after[0]),
            (after[1] - before[1]) / 1e6,
        )

    def test_modules_that_are_started_anew_leave_nothing(self):
        process = self.begin(RING)
        observed = self.observed(process)
        state = self.state(observed, self.all_run)
        counted = lambda: (*holdings(process.pid)[:2], sockets(), len(processes_of(process.pid)))
        for cycle in range(CYCLES + WARM):
            if cycle == WARM:
                before, memory = self.settled(counted), holdings(process.pid)[2]
            pids = {each["name"]: each["pid"] for each in state["modules"]}
            self.assertEqual(self.ask(process, *("restart " + name for name in NAMES)), ["ok"])
            is_again = lambda state: self.all_run(state) and all(
                each["pid"] not in (0, pids[each["name"]]) for each in state["modules"]
            )
            state = self.state(observed, is_again)
        wait_until(lambda: counted() == before)
        report(
            "%d restarts of %d modules in one graph: hc run has %d descriptors and %d threads, with "
            "%d sockets and %d processes in all, as before; its own memory %d kB before, %d after",
            *(CYCLES, COUNT, *before, memory, holdings(process.pid)[2]),
        )
        self.limit(holdings(process.pid)[2], memory + 512, "memory of hc run [kB]")
        self.halt(process)


if __name__ == "__main__":
    unittest.main()
