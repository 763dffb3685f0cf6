#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What people steer the head with falls silent, is there twice, and contradicts itself."""

import re
import socket
import struct
import time
import unittest

from table import Safety  # which knows the way to the others
from feeder import Feeder
from streams import bid, message, rotation, stick, stop

SECONDS = 2  # for which sources contradict each other [s]
SLOW = 0.6  # a push with which the head does not reach its limits for SECONDS
SILENCE = 0.1  # of a stick, shorter than the one that ends its turn [s]
PAUSE = 0.4  # of bids, shorter than the one after which they are withdrawn [s]


class People(Safety):
    def setUp(self):
        super().setUp()
        self.head.quiet()

    def feed(self, port, number, make, period=0.02):
        """A source that sends what `make` gives, by the time [s], until the end of the row."""
        source = self.head.source(port, number)
        feeder = Feeder(lambda now: source.send(make(now)), period)
        self.addCleanup(feeder.end)
        return feeder

    def end(self, feeder):
        """When a source has fallen silent [ns]."""
        moment = time.time_ns()
        feeder.end()
        return moment

    def note_silence(self, feeder):
        self.head.wait_moving()
        with self.head.waits() as waits:
            self.note_halt(self.end(feeder), waits)
        self.hold()

    def note_turns(self, begun, *feeders):
        """Of two sources that began after a time [ns], from when the head moves."""
        motion = self.head.motion
        moves = lambda: motion.moves(motion.since(begun))
        self.head.wait(moves, "the head moves")
        with self.head.waits() as waits:
            motion.wait_until(time.time_ns() + int(SECONDS * 1e9))
        self.note_without("turns", motion.turns(moves()[0]), SILENCE, feeders, waits)

    def note_without(self, limit, count, silence, feeders, waits, where=""):
        """Notes a count, without one for each time that a source, or what its messages pass through,
        got no processor for so long [s].
        """
        silences = sum(pause > silence for each in feeders for pause in each.pauses)
        silences += waits.silences(silence)
        where += " beside others who had the processor %d times" % silences
        self.note(limit, max(0, count - silences), where.strip())
        self.hold()

    def note_rest(self):
        """While a person drives, who may not."""
        head = self.head
        head.motion.rests_at(time.time_ns())
        begun = time.time_ns()
        head.sit(head.pushing())
        head.motion.wait_until(begun + int(SECONDS * 1e9))
        self.note("travelled", head.motion.travelled(begun))
        self.hold()

    def test_a_stick_falls_silent(self):
        way = self.head.to_and_fro()
        self.note_silence(self.feed("point.stick", 0, lambda _: stick(SLOW * way())))

    def test_two_sticks(self):
        begun = time.time_ns()
        left = self.feed("point.stick", 0, lambda _: stick(SLOW, src=90))
        right = self.feed("point.stick", 1, lambda _: stick(-SLOW, src=91))
        self.note_turns(begun, left, right)

    def test_two_setpoints(self):
        begun = time.time_ns()
        self.feed("telepresence.setpoint", 0, lambda _: rotation(0.5, src=90))
        self.feed("telepresence.setpoint", 1, lambda _: rotation(-0.5, src=91))
        self.note_turns(begun)

    def test_two_targets(self):
        begun = time.time_ns()
        target = lambda x, src: message(10390, "%d 300 0" % x, coord=7, src=src)
        self.feed("point.target", 0, lambda _: target(300, 90), 0.1)
        self.feed("point.target", 1, lambda _: target(500, 91), 0.1)
        self.note_turns(begun)

    def tracker(self, yaw):
        """A head tracker that turns to a side; what it sends [°] by the time [s]."""
        port = int(re.findall(r"listening on UDP \S+:(\d+)", self.head.said())[-1])
        sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(sender.close)
        send = lambda now: sender.sendto(
            struct.pack("<6d", 0, 0, 0, yaw(now), 0, 0), ("127.0.0.1", port)
        )
        feeder = Feeder(send)
        self.addCleanup(feeder.end)
        return feeder

    def test_a_tracker_falls_silent(self):
        self.note_silence(self.tracker(lambda now: 60 * abs(now % 2 - 1) - 30))

    def test_two_trackers(self):
        begun, turning = time.time_ns(), time.monotonic()
        self.tracker(lambda now: -15 * min(1, now - turning))
        self.head.wait_focus("telepresence")
        self.tracker(lambda now: 30)
        self.tracker(lambda now: 1e-321)
        self.note_turns(begun)

    def test_a_bid_falls_silent(self):
        head, mode = self.head, self.head.mode("telepresence")
        feeder = self.feed("workspace.person", 0, lambda _: bid(1, mode), 0.1)
        head.wait_focus("telepresence")
        with head.waits() as waits:
            moment = self.end(feeder)
            withdrawn = lambda: [at for at, now in head.focused.modes(moment) if now != mode]
            head.wait(withdrawn, "the bid is withdrawn")
        self.note_time("withdrawn", moment, withdrawn()[0], waits)
        self.hold()

    def test_two_bids(self):
        head, mode = self.head, self.head.mode("telepresence")
        high = self.feed("workspace.person", 0, lambda _: bid(1, mode, src=90), 0.1)
        head.wait_focus("telepresence")
        low = self.feed("workspace.person", 1, lambda _: bid(0, mode, src=91), 0.1)
        begun = time.time_ns()
        with head.waits() as waits:
            head.motion.wait_until(begun + int(SECONDS * 1e9))
        changes = head.focused.changes(begun)
        lost = sum(now != mode for _, now in changes)
        self.note_without("changes", lost, PAUSE, (high, low), waits, str(changes))

    def test_two_stops(self):
        head = self.head
        head.source("workspace.stop", 0).insist(stop(1, src=90))
        head.wait(lambda: head.page.session["stopped"], "the robot is stopped")
        feeder = self.feed("workspace.stop", 1, lambda _: stop(0, src=91), 0.1)
        self.note_rest()
        feeder.end()  # it leaves: its silence would stop the robot again
        head.source("workspace.stop", 1).insist(stop(3, src=91))

    def test_a_button_falls_silent(self):
        head = self.head
        button = head.source("workspace.stop")
        button.insist(stop(1, src=90))
        head.wait(lambda: head.page.session["stopped"], "the robot is stopped")
        button.end()
        self.note_rest()


if __name__ == "__main__":
    unittest.main()
