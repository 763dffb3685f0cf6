#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The driver's seat of the page: chosen and not touched, left, silent, cut off."""

import signal
import time
import unittest

from table import Safety  # which knows the way to the others
from head import IS_FULL
from driver import SILENCE, seat_bid, seat_stick
from feeder import Feeder
from page import ALIVE
from streams import stick
from threads import held_threads

UNTOUCHED, AFTER = (20, 30) if IS_FULL else (5, 5)  # [s]
ALIVE = ALIVE + b"0\n"


class Seat(Safety):
    def choose(self, task):
        """Takes the seat and chooses a task, once; when that was [ns]."""
        bids, moment = [seat_bid(1, self.head.mode(task))], time.time_ns()
        self.head.sit(lambda _: [bids.pop() if bids else ALIVE])
        return moment

    def untouched(self, task):
        """Measures the focus and the motion after a choice. False: no measurement, since the page
        got no processor for 0.2 s, and so left the seat."""
        head = self.head
        head.wait_focus("track")
        chosen = self.choose(task)
        head.wait(lambda: head.focus() == task or head.seat.was_silent(), task + " has the focus")
        with head.waits() as waits:
            head.motion.wait_until(chosen + int(UNTOUCHED * 1e9))
        changes = head.focused.changes(chosen)
        # Each time the focus is lost, and comes back.
        excused = 2 * waits.silences(SILENCE)
        # It may have been moving when that was chosen.
        travelled = head.motion.travelled(chosen + 10**9)
        is_valid = not head.seat.was_silent()
        head.leave()
        head.wait(lambda: head.focus() != task, "the seat is left")
        if is_valid:
            self.note("changes", max(0, len(changes) - excused), "%s: %s" % (task, changes))
            self.note("travelled", travelled, task)
        return is_valid

    def test_nothing_touched(self):
        for task in ("point", "telepresence"):
            while not self.untouched(task):
                pass
        self.hold()

    def let_go(self):
        """Measures the motion after a drag. False: no measurement, as above."""
        head = self.head
        head.drive()
        mode = head.mode("point")
        with head.waits() as waits:
            # The bid too: a page that got no processor for 0.2 s has left the seat.
            head.seat.says = lambda _: [seat_bid(1, mode), seat_stick(0)]
            self.note_halt(time.time_ns(), waits)
        halted = time.time_ns()
        head.motion.wait_until(halted + int(AFTER * 1e9))
        is_valid = not head.seat.was_silent()
        if is_valid:
            self.note("travelled", head.motion.travelled(halted))
        return is_valid

    def test_after_a_drag(self):
        while not self.let_go():
            pass
        self.hold()

    def note_end_of_push(self, does):
        """What is done while the stick is pushed, and when the head halts."""
        head = self.head
        head.quiet()
        head.drive()
        with head.waits() as waits:
            moment = time.time_ns()
            does()
            self.note_halt(moment, waits)
        self.hold()

    def test_the_page_is_silent(self):
        seat_says_nothing = lambda: setattr(self.head.seat, "says", lambda _: ())
        self.note_end_of_push(seat_says_nothing)

    def test_the_page_is_cut_off(self):
        self.note_end_of_push(self.head.close_page)

    def test_the_server_of_the_page_is_killed(self):
        self.note_end_of_push(lambda: self.head.send_signal("web", signal.SIGKILL))

    def test_a_stop_is_pressed_while_its_server_hangs(self):
        head = self.head
        head.wait(lambda: head.sent()["web.stop"] > 5, "the page guards the robot")
        pid = head.send_signal("web", signal.SIGSTOP)
        head.press_stop()
        head.motion.rests_at(time.time_ns())
        rested = time.time_ns()
        head.wait(lambda: head.is_whole() and head.pid("web") != pid, "it is restarted")
        head.motion.wait_until(time.time_ns() + int(2e9))  # in which tasks bid
        # A page opens, and repeats what was pressed.
        head.open_page()
        head.press_stop()
        head.wait(lambda: head.page.session["stopped"], "the robot is stopped")
        head.motion.wait_until(time.time_ns() + int(2e9))
        self.note("travelled", head.motion.travelled(rested))
        self.hold()

    def test_the_server_of_the_page_hangs_and_goes_on(self):
        head = self.head
        head.wait(lambda: head.sent()["web.stop"] > 5, "the page guards the robot")
        head.quiet()
        source, way = head.source("point.stick"), head.to_and_fro()
        feeder = Feeder(lambda _: source.send(stick(way())))
        self.addCleanup(feeder.end)
        head.wait_moving()
        with head.waits() as waits, held_threads(head.pid("web")):
            self.note_halt(time.time_ns(), waits)
            halted = time.time_ns()
            head.motion.wait_until(halted + int(2e9))
            self.note("travelled", head.motion.travelled(halted))
        head.wait_moving()
        self.hold()


if __name__ == "__main__":
    unittest.main()
