#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The scored tasks in which a person drives the head, shortened; the bounds of their figures are
those that only a broken system exceeds."""

import math
import re
import socket
import time
import unittest

from harness import ROOT, Pipes, if_quick, messages_of, wait_until


class Driving(Pipes):
    def score(self, graph, pattern, *parameters):
        """The numbers in the score's line."""
        sets = "".join(" --set " + parameter for parameter in parameters)
        self.shell("hc run %s/graphs/%s.toml%s" % (ROOT, graph, sets))
        found = re.search(pattern, self.err)
        self.assertTrue(found, self.err[-2000:])
        return [float(number) for number in found.groups()]

    def test_a_person_who_is_not_heard_is_not_followed(self):
        """One who is heard is, in side_by_side_test.py."""
        (rms,) = self.score(
            "score_telepresence",
            r"error ([\d.]+)° RMS",
            "follow_score.duration=4",
            "head_tracker.listen=",
        )
        # One that stood still would be off by 28°.
        self.assertGreater(rms, 15)

    def start_gaze(self, port):
        self.start(
            "exec hc gaze --mode 1 --timeout 1 --acceleration 0 --in %s=unix-listen:link"
            " --out command=file:commands --out bid=file:bids" % port
        )
        link = socket.socket(socket.AF_UNIX)
        self.addCleanup(link.close)
        # The file is there a moment before somebody listens.
        wait_until(lambda: link.connect_ex(self.path("link")) == 0)
        return link

    def wait_bid_end(self):
        """Waits until the bid ends, as it does when the timeout has."""

        def has_ended():
            bids = [row[0] for row in self.rows("bids")]
            return (0.5, 0) in zip(bids, bids[1:])

        wait_until(has_ended)

    def test_a_stick_in_its_middle_lets_go_of_no_other_stick(self):
        row = b"1 %d 0 0 8 0 120190 0 0 2 1\n%d 0\n"
        self.start_gaze("stick").sendall(row % (1, 1) + row % (2, 0) * 50)
        self.wait_bid_end()
        # Pushed for 0.1 s at 1 rad/s, or less where the machine stands still meanwhile; let go of,
        # it would turn for one step of 0.01 s.
        self.assertGreater(max(row[2] for row in self.rows("commands")), 0.03)

    def test_a_wish_that_is_not_told_again_does_not_run_away(self):
        link = self.start_gaze("setpoint")

        def is_wanted():
            """Tells it, and waits for what comes of it; nothing does where it came too late."""
            now = time.time_ns()
            for i in range(-100, 1):  # a head that turns by 1 rad/s, to 1 rad
                stamp = now + i * 10_000_000
                link.sendall(b"1 1 0 0 8 %d 20390 0 13 1 1\n0 0 %r\n" % (stamp, 1 + i / 100))
            by_no_clock = now + 3600 * 10**9
            link.sendall(b"1 1 0 0 8 %d 20390 0 13 1 1\n0 0 1\n" % by_no_clock)
            count = len(self.rows("bids"))
            wait_until(lambda: len(self.rows("bids")) > count + 20)
            return [0.5] in self.rows("bids")

        wait_until(is_wanted)
        self.wait_bid_end()
        pans = [row[2] for row in self.rows("commands")]
        self.assertGreater(max(pans), 0.99)
        self.assertLess(max(pans), 1.3)

    def test_a_stick_moves_the_head_each_time(self):
        median, most, moved, pushes = self.score(
            "score_point",
            r"first motion (-?[\d.]+) ms median, (-?[\d.]+) ms at most, of (\d+) of (\d+) pushes",
            "point_score.count=4",
        )
        self.assertEqual((moved, pushes), (4, 4))
        self.assertGreaterEqual(most, median)
        # The head does not move before the stick, within a period of the truth.
        self.assertGreater(median, -2)

    @if_quick
    def test_an_object_stays_in_the_room_while_the_head_turns(self):
        median, most, right, least, fastest = self.score(
            "score_augment",
            r"off by ([\d.]+) px median, ([\d.]+) px at most, pixels right ([\d.]+) % median, "
            r"([\d.]+) % at least, the head turning at up to ([\d.]+)°/s",
            "augment_score.images=10",
        )
        self.assertGreaterEqual(most, median)
        self.assertGreaterEqual(right, least)
        self.assertGreaterEqual(fastest, math.degrees(0.7) - 1)
        # One that turned with the head would be off by hundreds of pixels.
        self.assertLess(median, 40)
        self.assertGreater(right, 60)


class Gaze(Pipes):
    def test_a_wish_of_the_future_holds_nothing_back(self):
        now = time.time_ns()
        setpoints = "".join(
            "hc send --type rotation %s --coord 14 --time %d;" % (angles, stamp)
            for angles, stamp in (
                ("0 0.3 1", now + 60 * 10**9),
                ("0 0.1 0.2", now),
                ("0 0.1 0.2", now + 1000),
            )
        )
        out = self.shell(
            "(%s) | hc gaze --timeout 60 --in setpoint=- --out command=-" % setpoints, status=1
        )
        self.assertRegex(
            self.err,
            r"^gaze: setpoint: dropped: it is (59|60)\.\d+ s in the future .*\n"
            r"gaze: total: 1 bad at setpoint\n$",
        )
        angles = [each.rows[0] for each in messages_of(out)]
        self.assertGreaterEqual(len(angles), 2)
        self.assertEqual([each for each in angles if each != [0, 0.1, 0.2]], [])

    def commands(self, *inputs, status=0):
        """Rows of what is commanded after some messages, files of MTP by their ports."""
        links = ""
        for number, (port, text) in enumerate(inputs):
            self.write("%d.mtp" % number, text)
            links += " --in %s=file:%d.mtp" % (port, number)
        out = self.shell("hc gaze --timeout 60 --acceleration 0%s --out command=-" % links, status)
        return [each.rows[0] for each in messages_of(out)]

    @staticmethod
    def setpoint(pan, stamp, coord, source=1):
        return "1 %d 0 0 8 %d 20390 0 %d 1 1\n0 0 %r\n" % (source, stamp, coord, pan)

    def test_an_orientation_in_the_head_s_frame_is_turned_into_the_robot_s(self):
        now = time.time_ns()
        c, s = math.cos(0.5), math.sin(0.5)
        pose = "1 2 0 0 8 %d 70190 0 2003 4 4\n" % now + (
            "%r %r 0 0\n%r %r 0 0\n0 0 1 0\n0 0 0 1\n" % (c, -s, s, c)
        )
        for coord, pan in ((3, 0.75), (2, 0.25), (13, 0.25), (14, 0.25)):
            rows = self.commands(("frames", pose), ("setpoint", self.setpoint(0.25, now, coord)))
            self.assertTrue(rows, self.err)
            self.assertAlmostEqual(rows[-1][2], pan, 3, (coord, self.err))

    def test_an_orientation_in_no_known_frame_is_refused_by_its_name(self):
        now = time.time_ns()
        for coord in (205, 7, 20):
            both = self.setpoint(1, now, coord) + self.setpoint(0.25, now + 1000, 13)
            rows = self.commands(("setpoint", both), status=1)
            self.assertEqual({row[2] for row in rows}, {0.25}, self.err)
            self.assertIn("setpoint: dropped: coordinate system %d is not one of" % coord, self.err)

    def test_two_that_set_the_head_do_not_alternate(self):
        now = time.time_ns()
        both = ""
        for i in range(50):
            both += self.setpoint(0.25, now + i, 14) + self.setpoint(-0.25, now + i, 14, 2)
        rows = self.commands(("setpoint", both))
        self.assertEqual({round(row[2], 3) for row in rows}, {0.25})
        self.assertIn("setpoint of source 2 dropped: source 1 is in control", self.err)

    def test_what_is_of_another_time_moves_nothing(self):
        now = time.time_ns()
        for stamp in (1, now - 3600 * 10**9, now + 3600 * 10**9):
            push = "1 1 0 0 8 %d 120190 0 0 2 1\n1 0\n" % stamp
            target = "1 1 0 0 8 %d 10390 0 2 1 1\n2 1 0\n" % stamp
            setpoint = self.setpoint(1, stamp, 13)
            rows = self.commands(
                ("stick", push), ("target", target), ("setpoint", setpoint), status=1
            )
            self.assertEqual(rows, [])
            for what in ("stick", "target", "setpoint"):
                self.assertRegex(
                    self.err, "gaze: %s: dropped: it is .* s (old|in the future)" % what
                )
                self.assertIn("1 bad at %s" % what, self.err)

    def test_of_two_sticks_that_are_pushed_one_is_obeyed(self):
        row = "1 %d 0 0 8 0 120190 0 0 2 1\n%d 0\n"
        rows = self.commands(("stick", (row % (1, 1) + row % (2, -1)) * 50))
        self.assertGreater(min(row[2] for row in rows), 0)
        self.assertIn("stick of source 2 dropped: source 1 is in control", self.err)


if __name__ == "__main__":
    unittest.main()
