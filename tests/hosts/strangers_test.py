#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What others get of a graph over several hosts: without its key, or as another user. Needs root.

    strangers_test.py BUILD_FOLDER [TEST …]
"""

import os
import pathlib
import signal
import subprocess
import sys
import unittest

from hosts import BRIGHTNESS, CAMERA, HostsTest, WATCHDOG


class Strangers(HostsTest):
    def test_the_key_of_the_previous_run_is_refused(self):
        (host,) = self.network.add()
        process, messages, state = self.run_two(host)
        reader = self.module(state, "brightness")["pid"]
        key = pathlib.Path("/proc/%d/fd/3" % reader).read_text()
        self.assertIn("PRIVATE", key)
        self.write("key.pem", key)
        self.stop(process)
        process = self.run_graph()
        messages = self.observe(process)
        self.flows(messages)
        (port,) = self.ports_of(host)
        with_key = "-cert {0} -key {0}".format(self.path("key.pem"))
        done = self.connect_by_tls(host, port, with_key)
        self.assertEqual(done.stdout, b"")
        self.assertRegex(done.stderr, b"alert")
        self.await_lines(process, "camera: .*: .*key")
        self.flows(messages)
        self.stop(process)
        self.assert_empty(host)

    @staticmethod
    def names_of(host):
        """Those of the abstract namespace where somebody listens."""
        return [
            row.split()[-1][1:]
            for row in host.inside("cat /proc/net/unix", stdout=-1).stdout.decode().splitlines()
            if "@hc-" in row and row.split()[3] == "00010000"
        ]

    def test_another_user_takes_no_name_while_its_module_restarts(self):
        (host,) = self.network.add()
        self.write_graph(self.tables(host) + CAMERA % "h1" + BRIGHTNESS % 'host = "h1"\n')
        process = self.run_graph()
        messages = self.observe(process)
        state = self.flows(messages)
        names = self.names_of(host)
        self.assertTrue([name for name in names if "camera" in name], names)
        script = """
import os, select, socket, sys
os.setgid(65534); os.setuid(65534)
print("ready", flush=True)
while not select.select([0], [], [], 0)[0]:
    for name in sys.argv[1:]:
        with socket.socket(socket.AF_UNIX) as taken:
            try:
                taken.bind("\\0" + name)
                print(name, flush=True)
            except OSError:
                pass
"""
        command = [*host.enter(sys.executable), "-c", script, *names]
        with subprocess.Popen(command, stdin=-1, stdout=-1) as stranger:
            self.assertEqual(stranger.stdout.readline(), b"ready\n")
            for _ in range(3):
                restarts = self.module(state, "camera")["restarts"]
                os.kill(self.modules_of(host)["camera"], signal.SIGKILL)
                self.state(
                    messages, lambda state: self.module(state, "camera")["restarts"] > restarts
                )
                state = self.flows(messages, self.state(messages)["links"][0]["messages"])
            self.assertEqual(stranger.communicate()[0], b"")
        self.stop(process)
        self.assert_empty(host)

    def test_other_users_get_nothing(self):
        (host,) = self.network.add()
        process, messages, _ = self.run_two(host)
        camera = self.modules_of(host)["camera"]
        words = pathlib.Path("/proc/%d/cmdline" % camera).read_bytes()
        self.assertIn(b"key=/proc/self/fd/3", words)
        self.assertNotIn(b"PRIVATE", words + pathlib.Path("/proc/%d/environ" % camera).read_bytes())
        self.assertIn(b"PRIVATE", pathlib.Path("/proc/%d/fd/3" % camera).read_bytes())
        names = self.names_of(host)
        self.assertEqual(len([name for name in names if name.endswith(".control")]), 1)
        script = (
            """
import os, socket, sys
os.setgid(65534); os.setuid(65534)
try:
    print(open("/proc/%d/fd/3").read())
except OSError:
    pass
for name in sys.argv[1:]:
    peer = socket.socket(socket.AF_UNIX)
    peer.settimeout(60)
    peer.connect("\\0" + name)
    try:
        print(peer.recv(1000).decode(), end="")
    except ConnectionError:
        pass
"""
            % camera
        )
        command = [*host.enter(sys.executable), "-c", script, *names]
        done = subprocess.run(command, stdout=-1, stderr=-1, timeout=WATCHDOG)
        self.assertEqual((done.returncode, done.stdout), (0, b""), done)
        self.flows(messages)
        self.stop(process)
        self.assert_empty(host)


if __name__ == "__main__":
    unittest.main()
