#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Graphs over several hosts that lose a process, the network or the disk. Needs root.

    losses_test.py BUILD_FOLDER [TEST …]

HC_FULL=1 kills each of agent, runner, sshd's child and module 50 times, else twice, and holds all
to the times that doc/hosts.md promises.
"""

import os
import pathlib
import re
import resource
import unittest

from hosts import BRIGHTNESS, CAMERA, FULL, HostsTest, wait_until
from recordings import read_messages

TIMES = 50 if FULL else 2


class Losses(HostsTest):
    def recovers_from(self, victim, at_once=TIMES):
        """Kills it TIMES, `at_once` in a run of the graph."""
        (host,) = self.network.add()
        for done in range(0, TIMES, at_once):
            process, messages, state = self.run_two(host)
            for _ in range(min(at_once, TIMES - done)):
                camera = self.modules_of(host)["camera"]
                self.kill(victim(host))
                wait_until(lambda: not os.path.exists("/proc/%d" % camera))
                state = self.state(
                    messages, lambda state: self.module(state, "camera")["pid"] not in (0, camera)
                )
                state = self.flows(messages, state["links"][0]["messages"])
            self.stop(process)
            self.assert_empty(host)

    def test_a_killed_agent(self):
        self.recovers_from(self.agent_of)

    def test_a_killed_child_of_sshd(self):
        self.recovers_from(self.child_of_sshd)

    def test_a_killed_module(self):
        # More restarts in a row are delayed, and end (G40).
        self.recovers_from(lambda host: self.modules_of(host)["camera"], at_once=5)

    def test_a_killed_runner(self):
        (host,) = self.network.add()
        self.write_graph(self.tables(host) + CAMERA % "h1" + BRIGHTNESS % "")
        for _ in range(TIMES):
            process = self.run_graph()
            self.flows(self.observe(process))
            self.kill(process.pid)
            process.communicate()
            self.assert_empty(host)
            self.assertNotIn("ssh ", " ".join(self.own_programs()))

    def test_a_cut_cable(self):
        (host,) = self.network.add()
        process, messages, state = self.run_two(host)
        host.cut()
        self.assert_empty(host)
        lost = self.state(messages, lambda state: not state["hosts"][0]["connected"])
        self.assertNotEqual(lost["hosts"][0]["detail"], "")
        waits = self.state(
            messages, lambda state: self.module(state, "camera")["status"] == "waiting"
        )
        self.assertIn("host h1 is not connected", self.module(waits, "camera")["detail"])
        # The graph can be changed meanwhile; the host gets the changes when it is back.
        self.assertEqual(self.ask(process, "set camera.rate=20", "restart brightness"), ["ok"])
        host.cut(False)
        state = self.flows(messages, state["links"][0]["messages"])
        self.assertEqual(self.module(state, "camera")["parameters"]["rate"], "20")
        host.cut()
        self.stop(process)  # also while it is cut
        self.assert_empty(host)

    def recorder(self, messages):
        """The number of its process, once it has one."""
        state = self.state(
            messages, lambda state: (self.module(state, "recorder") or {}).get("pid")
        )
        return self.module(state, "recorder")["pid"]

    def test_a_full_disk_ends_a_recording_into_a_folder_and_not_the_robot(self):
        (host,) = self.network.add()
        self.write_graph(self.tables(host) + CAMERA % "h1" + BRIGHTNESS % "")
        process = self.run_graph("--record kept")
        messages = self.observe(process)
        self.flows(messages)
        resource.prlimit(self.recorder(messages), resource.RLIMIT_FSIZE, (2 << 20, 2 << 20))
        lines = self.await_lines(process, "error: recording ended")
        self.assertRegex(
            lines[-1],
            r"ended: kept/camera\.left\.mtp: write\(\): File too large; the messages written before are kept",
        )
        state = self.state(messages)
        self.flows(messages, state["links"][0]["messages"] + 50)
        out, err = self.stop(process, 1)
        self.assertNotIn("recording ended", err)  # once is enough
        said = re.search(r"recorder: (\d+) messages in kept, (\d+) not recorded", out)
        self.assertGreater(int(said[2]), 0)
        kept = {
            name: read_messages(self.path("kept/" + name)) for name in os.listdir(self.path("kept"))
        }
        self.assertEqual(int(said[1]), sum(map(len, kept.values())))
        self.assertGreater(len(kept["camera.left.mtp"]), 100)
        self.assert_empty(host)

    def test_a_recording_goes_on_in_its_folder(self):
        """Where the recorder is restarted: other outputs are recorded, and it is killed."""
        (host,) = self.network.add()
        self.write_graph(self.tables(host) + CAMERA.replace('host = "%s"', "") + BRIGHTNESS % "")
        process = self.run_graph("--record kept")
        messages = self.observe(process)
        self.state(messages, lambda state: self.rate(state, "camera.left", "brightness.image"))
        before = 0

        def goes_on():
            nonlocal before
            least = before + 50
            wait_until(lambda: self.count("kept") > least)
            before = self.count("kept")

        goes_on()
        self.assertEqual(self.ask(process, "add more@h1 brightness"), ["ok"])
        wait_until(lambda: os.path.exists(self.path("kept/more.trace.mtp")))
        goes_on()
        for name in ("recorder", "camera"):
            pid = lambda state, name=name: self.module(state, name)["pid"]
            lives = lambda state, pid=pid: os.path.exists("/proc/%d" % pid(state))
            self.kill(pid(self.state(messages, lives)))
            goes_on()
        self.assertEqual(self.ask(process, "remove more"), ["ok"])
        goes_on()
        self.stop(process)
        self.assertFalse(os.path.exists(self.path("kept_2")))
        self.assertIn("seq restarted 1 time", self.shell("hc info kept/camera.left.mtp"))
        self.assert_empty(host)

    def count(self, folder):
        """How many images a recording has by now."""
        path = pathlib.Path(self.path(folder), "camera.left.mtp")
        return path.stat().st_size // (80 * 60 * 3) if path.exists() else 0


if __name__ == "__main__":
    unittest.main()
