#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a person steers the robot head with: head tracker and joystick."""

import math
import os
import pathlib
import re
import socket
import struct
import unittest

from bodies import Bodies
from harness import free_port, wait_until


class HeadTracker(Bodies):
    def setUp(self):
        super().setUp()
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(self.socket.close)

    def start_tracker(self, options="", listen="0"):
        process = self.run_module(
            "hc head_tracker %s --out rotation=file:rotation --out position=file:position %s"
            % (listen, options)
        )
        self.wait_for("listening on UDP")
        self.port = int(re.search(r"listening on UDP \S+:(\d+)", self.said())[1])
        return process

    def send(self, *numbers):
        self.socket.sendto(struct.pack("<6d", *numbers), ("127.0.0.1", self.port))

    def feed(self, *numbers):
        """Sends a pose, and waits until it has come through."""
        before = len(self.rows("position"))
        self.send(*numbers)
        wait_until(lambda: len(self.rows("position")) > before)
        return self.rows("rotation")[-1], self.rows("position")[-1]

    def assert_close(self, found, expected):
        self.assertEqual(len(found), len(expected))
        for a, b in zip(found, expected):
            self.assertAlmostEqual(a, b, places=9)

    def test_signs_units_and_the_first_pose_as_zero(self):
        process = self.start_tracker()
        rotation, position = self.feed(1, 2, 3, 0, 0, 0)
        self.assert_close(rotation + position, [0] * 6)
        # To the right and up, tilted; 10 cm right, 20 cm up, 30 cm back.
        rotation, position = self.feed(11, 22, 33, 30, 20, 10)
        self.assert_close(rotation, [math.radians(a) for a in (10, -20, -30)])
        self.assert_close(position, [-0.3, -0.1, 0.2])
        header = self.read("rotation").split()
        self.assertEqual(header[6:11], ["20390", "0", "14", "1", "1"])
        self.assertGreater(int(header[5]), 1_600_000_000_000_000_000)
        self.stop(process)

    def test_is_centred_by_any_message(self):
        port = free_port()
        process = self.start_tracker("--centre_first=false --in centre=tcp-listen:%d" % port)
        rotation, _ = self.feed(0, 0, 0, -40, 0, 0)
        self.assert_close(rotation, [0, 0, math.radians(40)])
        self.shell("hc send --out tcp:127.0.0.1:%d 1" % port)
        wait_until(lambda: abs(self.feed(0, 0, 0, -40, 0, 0)[0][2]) < 1e-9)
        rotation, _ = self.feed(0, 0, 0, -50, 0, 0)
        self.assert_close(rotation, [0, 0, math.radians(10)])
        self.assertNotIn("first pose", self.said())
        self.stop(process)

    def test_a_flood_of_packets_costs_no_memory_and_no_pose(self):
        process = self.start_tracker()

        def memory():  # [kB]
            text = pathlib.Path("/proc/%d/status" % process.pid).read_text()
            return int(re.search(r"VmRSS:\s*(\d+)", text)[1])

        self.feed(0, 0, 0, 0, 0, 0)
        before = memory()
        good = struct.pack("<6d", 0, 0, 0, 10, 0, 0)
        bad = b"x" * 49, struct.pack("<6d", *[math.nan] * 6), b"", b"y" * 1400
        for number in range(100_000):
            self.socket.sendto(
                bad[number % 8 // 2] if number % 2 else good, ("127.0.0.1", self.port)
            )
        turned = lambda: abs(self.rows("rotation")[-1][2] - math.pi / 2) < 1e-9
        wait_until(lambda: self.send(0, 0, 0, -90, 0, 0) or turned())
        self.assertLess(memory() - before, 10_000)
        self.assertEqual(
            {round(math.degrees(row[2])) for row in self.rows("rotation")}, {0, -10, 90}
        )
        self.stop(process)
        self.assertEqual(self.said().count("ignored a packet"), 1, self.said())
        self.assertRegex(self.said(), r"head_tracker: total: \d+ invalid packet")

    def test_it_listens_only_where_it_is_asked_to(self):
        process = self.run_module("hc head_tracker --out rotation=file:rotation")
        self.wait_for("idle: `listen` names no port; opentrack's is 4242")
        with open("/proc/net/udp") as table:  # the inode of a socket is its tenth word
            sockets = {"socket:[%s]" % line.split()[9] for line in table.readlines()[1:]}
        folder = "/proc/%d/fd" % process.pid
        links = {os.readlink(os.path.join(folder, name)) for name in os.listdir(folder)}
        self.assertFalse(links & sockets)
        self.stop(process)

    def test_a_host_that_is_none_is_a_clear_error(self):
        self.shell("hc head_tracker nowhere.invalid:0", status=2)
        self.assertIn('head_tracker: Invalid: host "nowhere.invalid": ', self.err)


class Joystick(Bodies):
    def test_waits_where_there_is_none(self):
        process = self.run_module("hc joystick --out stick=file:stick --out buttons=file:buttons")
        wait_until(lambda: self.said() or process.poll() is not None)
        self.assertIsNone(process.poll())
        if "no joystick found; waiting" in self.said():  # a machine with a joystick says its name
            self.assertEqual(self.rows("stick"), [])
        self.stop(process)


if __name__ == "__main__":
    unittest.main()
