#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The module camera with network cameras whose images arrive in bursts."""

import os
import time
import unittest

from harness import PYTHON, Pipes, messages_of, wait_until

SERVER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "rtsp_server.py")
RATE, BURST, PHASE = 20, 0.1, 0.05
PERIOD = 1e9 / RATE  # [ns]
STEP, GREYS = 16, 16  # of the server


class Rtsp(Pipes):
    def cameras(self, *phases):
        """Starts a server; gives the cameras' addresses."""
        phases = " ".join(map(str, phases))
        self.start("exec %s %s %d %g %s >ports" % (PYTHON, SERVER, RATE, BURST, phases))
        ports = wait_until(lambda: self.read("ports").endswith("\n") and self.read("ports"))
        return ["rtsp://127.0.0.1:%s/eye" % port for port in ports.split()]

    def images(self, cameras, count):
        """The times and numbers of images by the sender; numbers count on from that of the first."""
        command = "hc camera %s --width 1 --height 1 --count %d --encoding text"
        eyes = {}
        for message in messages_of(self.shell(command % (" ".join(cameras), count))):
            number = round(message.rows[0][0] / STEP)
            times, numbers = eyes.setdefault(message.src, ([], []))
            if numbers:
                number = numbers[-1] + (number - numbers[-1]) % GREYS
            times.append(message.time)
            numbers.append(number)
        return eyes

    def assert_regular(self, times, numbers):
        """Whether times are as far apart as the images were taken, not as they arrived."""
        for i in range(1, len(times)):
            expected = (numbers[i] - numbers[i - 1]) * PERIOD
            self.assertAlmostEqual(times[i] - times[i - 1], expected, delta=PERIOD / 10)

    def test_images_have_the_times_of_the_stream(self):
        before = time.time_ns()
        eyes = self.images(self.cameras(0), 100)
        times, numbers = eyes[1]
        # The first ones were waiting while the stream was opened.
        self.assert_regular(times[-40:], numbers[-40:])
        self.assertTrue(before < times[0] <= times[-1] < time.time_ns())
        self.assertEqual(times, sorted(times))

    def test_two_cameras_are_paired_by_these_times(self):
        eyes = self.images(self.cameras(0, PHASE), 160)
        (times, left), (others, right) = eyes[1], eyes[2]
        self.assertEqual(times, others)
        apart = right[-1] - left[-1]  # of the numbers of their first images
        self.assertEqual(apart % GREYS, 0)
        pairs = list(zip(left, right))[-100:]
        self.assertEqual({b - a for a, b in pairs}, {apart})
        # At least 15 of 20 pairs a second: a busy machine may lose some.
        self.assertLess(pairs[-1][0] - pairs[0][0], 100 * RATE / 15)
        self.assert_regular(times[-100:], left[-100:])


if __name__ == "__main__":
    unittest.main()
