#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The wall clock of the head's machine is set while a person drives."""

import time
import unittest

from table import Safety  # which knows the way to the others
from harness import BUILD

HOUR = 3600
PRELOAD = "env WALL_CLOCK=FOLDER/clock LD_PRELOAD=%s" % (BUILD / "tests/wall_clock.so")


class Clock(Safety):
    begin = dict(Safety.begin, prefix=PRELOAD, by_arrival=True)

    def step(self, seconds):
        self.head.write("clock", str(seconds))

    def test_the_clock_is_set(self):
        head = self.head
        before = head.restarts()
        for seconds in (HOUR, 0, -HOUR, 100 - int(time.time()), 0):
            where = "%+d s" % seconds
            head.drive()
            self.step(seconds)
            begun = time.time_ns()
            head.motion.wait_until(begun + 3 * 10**8)
            head.wait_moving()
            self.note("obeys", max(0, (time.time_ns() - begun) / 1e9 - 0.3), where)
            with head.waits() as waits:
                self.note_halt(head.press_stop(), waits, where)
            head.clear_stop()
        self.note_ended(before)
        self.hold()


if __name__ == "__main__":
    unittest.main()
