#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""hc estop, in a network of its own, since it stops the robots of all graphs."""

import os
import signal
import socket
import threading
import unittest

from namespaces import move_to_own_network

OWN = move_to_own_network()

# They take an argument away.
from graphs import STOPPABLE, Graphs  # noqa: E402
from harness import wait_until  # noqa: E402


@unittest.skipUnless(OWN, "no network namespaces, and graphs of others would be stopped")
class Estop(Graphs):
    def begin(self, name):
        # A file for each: a graph is changed when its file is written.
        self.write(name + ".toml", "version = 1\n" + STOPPABLE.replace(":stop", ":%s.stop" % name))
        process = self.start("exec hc run %s.toml 2>%s" % (name, name))
        wait_until(lambda: "workspace: focus: look" in self.read(name))
        return process

    def test_all_robots_are_stopped(self):
        processes = [self.begin(name) for name in ("one", "two")]
        self.shell("hc estop clear", 2)
        self.assertIn("several graphs are running; pass --of NAME", self.err)
        os.kill(processes[0].pid, signal.SIGSTOP)  # does not delay the stop of the other
        stopping = self.start("exec hc estop")
        line = stopping.stderr.readline().decode()
        hint = r" is stopped; hc estop clear --of %s lets it move again\n$"
        self.assertRegex(line, r"^hc estop: two\.\d+" + hint % "two")
        os.kill(processes[0].pid, signal.SIGCONT)
        line = stopping.stderr.readline().decode()
        self.assertRegex(line, r"^hc estop: one\.\d+" + hint % "one")
        self.assertEqual(stopping.wait(), 0)
        for process in processes:
            self.stop(process)
        self.shell("hc estop", 1)
        self.assertIn("no graph with a workspace is running here", self.err)

    def test_one_robot_is_stopped_and_let_go(self):
        name = "head"
        process = self.begin(name)
        self.shell("hc graph stop " + name, 2)
        self.assertIn('did you mean "--of %s"?' % name, self.err)
        estop = "hc estop --of " + name
        for _ in range(2):
            self.shell(estop)
            self.assertRegex(self.err, r"^hc estop: %s\.\d+ is stopped; hc estop clear" % name)
            self.assertIn(", stopped", self.shell("hc ps"))
        self.assertIn("stopped by a program outside the graph", self.read(name))
        self.shell(estop + " clear")
        self.assertRegex(self.err, r"^hc estop: %s\.\d+ may move\n$" % name)
        self.assertNotIn(", stopped", self.shell("hc ps"))
        # A source that repeats its stop, as a page.
        with socket.socket(socket.AF_UNIX) as link:
            link.connect(self.path(name + ".stop"))
            is_done = threading.Event()

            def repeat():
                while not is_done.wait(0.05):
                    link.sendall(b"1 12 0 0 8 0 120100 0 0 1 1\n1\n")

            repeating = threading.Thread(target=repeat)
            repeating.start()
            self.shell(estop + " clear", 1)
            is_done.set()
            repeating.join()
        self.assertIn("NOT cleared: stopped by source 12; a source that repeats", self.err)
        self.shell(estop + " clear")
        self.shell(estop + " now", 2)
        # A workspace that hangs.
        self.shell(estop)
        workspace = self.module(self.state_of(process, name), "workspace")["pid"]
        os.kill(workspace, signal.SIGSTOP)
        self.shell(estop + " clear", 1)
        self.assertIn("NOT cleared: workspace does not run, or hangs", self.err)
        os.kill(workspace, signal.SIGCONT)
        self.stop(process)


if __name__ == "__main__":
    unittest.main()
