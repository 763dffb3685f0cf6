#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""hc run as the first process of a container: a namespace of processes, on a network that others
share."""

import contextlib
import os
import pathlib
import signal
import subprocess
import unittest

from graphs import GRAPH, Graphs
from harness import WATCHDOG, wait_until
from namespaces import UNSHARE

# To enter one again.
ENTER = ["nsenter", *([] if os.geteuid() == 0 else ["--user", "--preserve-credentials"]), "--pid"]
CONTAINER = [*UNSHARE, "--pid", "--fork", "--mount-proc"]


def children(number):
    """The names of a process's children, by their numbers."""
    found = {}
    for child in pathlib.Path("/proc/%d/task/%d/children" % (number, number)).read_text().split():
        with contextlib.suppress(FileNotFoundError):  # it has just been reaped
            found[int(child)] = pathlib.Path("/proc/%s/comm" % child).read_text().strip()
    return found


class Containers(Graphs):
    def setUp(self):
        super().setUp()
        if subprocess.run([*CONTAINER, "true"], stderr=-3, check=False).returncode != 0:
            self.skipTest("this machine permits no namespace of processes")
        self.write_graph(GRAPH)

    def start_container(self, options=""):
        return self.start("exec %s hc run g.toml %s" % (" ".join(CONTAINER), options))

    def run_container(self, options=""):
        """A container whose graph runs: the process outside of it, and its first one."""
        outside = self.start_container(options)
        self.await_lines(outside, "brightness: started")
        (first,) = children(outside.pid)
        self.addCleanup(self.end_container, outside, first)
        return outside, first

    def end_container(self, outside, first):
        if outside.poll() is None:
            os.kill(first, signal.SIGKILL)
            outside.communicate(timeout=WATCHDOG)

    def test_orphans_are_reaped(self):
        _, first = self.run_container()
        inside = [*ENTER, "--target", str(first), "sh", "-c", "sleep 1000 >&- 2>&- &"]
        subprocess.run(inside, check=True)
        wait_until(lambda: "sleep" in children(first).values())
        orphan = next(number for number, name in children(first).items() if name == "sleep")
        os.kill(orphan, signal.SIGKILL)
        wait_until(lambda: orphan not in children(first))

    def test_signals_and_the_status_are_those_of_the_graph(self):
        for number in signal.SIGTERM, signal.SIGINT:
            outside, first = self.run_container()
            os.kill(first, number)
            out, err = outside.communicate(timeout=WATCHDOG)
            self.assertEqual(outside.returncode, 0, err)
            self.assertIn(b"g.toml ran for ", out)
            self.assertIn(b"graph: stopping\n", err)

    def test_two_that_share_a_network_need_two_names(self):
        self.run_container()
        second = self.start_container()
        _, err = second.communicate(timeout=WATCHDOG)
        self.assertEqual(second.returncode, 1, err)
        self.assertIn(b"Address already in use; another container on this network may run", err)
        self.assertIn(b"--as", err)
        self.run_container("--as other")


if __name__ == "__main__":
    unittest.main()
