#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The driver of a pan-tilt unit against a simulated one, with every fault that the line can have."""

import math
import os
import pathlib
import re
import signal
import time
import unittest

from harness import wait_until
from necks import Necks, STEP


class PanTilt(Necks):
    def test_turns_and_tells_where_it_looks(self):
        self.start_both("--hold 0", "--pan 0.3 --tilt -0.1")
        self.assertAlmostEqual(self.gaze.angles()[0][1], 0.3, delta=STEP)
        self.assertAlmostEqual(self.gaze.angles()[0][0], -0.1, delta=STEP)
        self.go(-0.5, 0.2)
        stamp, coord, ((roll, tilt, pan),) = self.gaze.wait(3)
        self.assertEqual((coord, roll), (13, 0))
        self.assertAlmostEqual(pan, -0.5, delta=STEP)
        self.assertAlmostEqual(tilt, 0.2, delta=STEP)
        self.assertLess(abs(time.time_ns() - stamp), 60e9)
        wait_until(lambda: self.pose.messages[-1][0] >= stamp)
        coord, rows = self.pose.messages[-1][1:]
        self.assertEqual(coord, 2003)
        forward = [row[0] for row in rows]  # where the head's x axis points to
        expected = [math.cos(tilt) * math.cos(pan), math.cos(tilt) * math.sin(pan), -math.sin(tilt)]
        for one, other in zip(forward, expected + [0]):
            self.assertAlmostEqual(one, other)
        self.assertEqual([row[3] for row in rows], [0, 0, 0, 1])
        self.assertAlmostEqual(rows[0][1], -math.sin(pan))

    def test_degrees_are_refused(self):
        self.start_both("--hold 0")
        self.command(30.0, 0.0)
        self.neck.wait_line("30 rad is more than a turn; tilt and pan are in rad, not in degrees")
        self.go(0.2)
        self.assertLess(max(pan for _, pan in self.motion.angles()), 0.2 + STEP)

    def stop_for(self, nanoseconds, program, meanwhile):
        """Stops a program as a debugger does, does something, and lets it continue later."""
        program.process.send_signal(signal.SIGSTOP)
        meanwhile()
        end = self.motion.wait()[0] + nanoseconds
        wait_until(lambda: self.motion.messages[-1][0] > end)
        program.process.send_signal(signal.SIGCONT)

    def test_commands_that_waited_for_the_driver_are_not_carried_out(self):
        self.start_fake("--out received=file:%s" % self.path("received"))
        self.start_ready(age=0.2)

        def command_all():
            for tenth in range(5, 25):
                self.command(-tenth / 10, 0.0)
                self.command(-tenth / 10, 0.0, 0.1)  # a little ahead of its time
                self.command(-tenth / 10, 0.0, timed=False)

        self.stop_for(1_000_000_000, self.neck, command_all)
        self.drive(0.3, lambda pan: abs(pan - 0.3) < STEP)
        pans = set(re.findall(r"pp(-?\d+)", pathlib.Path(self.path("received")).read_text()))
        self.assertEqual(pans, {str(round(0.3 / STEP))})
        self.assertGreaterEqual(min(pan for _, pan in self.motion.angles()), -STEP)
        for reason in ("(old|in the future)", "no time"):
            said = [line for line in self.neck.lines if re.search(reason + r" \(further", line)]
            self.assertEqual(len(said), 1, self.neck.lines)

        # And there is no talk of a fault: the answers have waited too.
        self.assertEqual(len(self.neck.lines), 3, self.neck.lines)
        self.neck.process.terminate()
        # Of those to 0.3 rad, too, some may have waited on a busy machine.
        self.neck.wait_line(" stale, 20 without a time")
        stale = re.search(r"total: .*?(\d+) stale, 20 without a time", "\n".join(self.neck.lines))
        self.assertGreaterEqual(int(stale[1]), 40)

    def test_a_name_that_stays_is_opened_when_it_is_there_and_there_again(self):
        link = self.path("neck")
        self.start_neck("--hold 0", device=link)
        self.neck.wait_line("neck: open: No such file")
        self.command(1.0, 0.0)
        self.neck.wait_line("pan-tilt unit not connected")
        self.start_fake(device=self.path("devices"))

        def devices():
            file = pathlib.Path(self.path("devices"))
            return re.findall(r"(/dev/\S+)\n", file.read_text()) if file.exists() else []

        def plug(before):
            wait_until(lambda: len(devices()) > before)
            os.symlink(devices()[-1], link + ".new")
            os.rename(link + ".new", link)

        plug(0)
        self.gaze.wait()
        for pan in 0.2, -0.2:
            begin = len(self.neck.lines)
            self.fake.set("unplugged=true")
            self.neck.wait_line("disconnected", begin)
            before = len(devices())
            self.fake.set("unplugged=false")
            plug(before)
            self.answers_again(begin, 3)
            self.go(pan)

    def test_either_killed_leaves_nothing_and_is_found_again(self):
        self.start_both("--hold 0")
        self.gaze.wait()
        self.motion.wait()
        self.neck.process.send_signal(signal.SIGKILL)
        self.neck.process.wait()
        self.start_ready("--hold 0")
        self.go(0.2)
        begin = len(self.neck.lines)
        self.fake.process.send_signal(signal.SIGKILL)
        self.fake.process.wait()
        self.neck.wait_line("disconnected", begin)
        self.start_fake("--pan -0.4")
        self.answers_again(begin, 10)
        self.assertAlmostEqual(self.gaze.angles()[-1][1], -0.4, delta=STEP)
        for each in self.fake, self.neck:
            each.process.send_signal(signal.SIGKILL)
            each.process.wait()
        self.assertEqual(os.listdir(self.folder.name), [])


if __name__ == "__main__":
    unittest.main()
