# SPDX-License-Identifier: Apache-2.0
"""Rows of the table of doc/safety.md that are tried on a running head."""

import json
import time
import unittest

from head import IS_FULL, SMALL, Head  # which knows the way to the others
from harness import BUILD, end_when_hung
from rows import Row


class Rows(unittest.TestCase):
    """Rows of the table, a test each, on what is `head` meanwhile."""

    def setUp(self):
        end_when_hung(self)
        self.row, self.broken = Row(self._testMethodName.removeprefix("test_"), BUILD), []
        self.begun = time.monotonic()

    def tearDown(self):
        self.row.keep()

    def note(self, limit, value, where="", excused=0):
        """Takes a measurement; the row fails at its end where it is beyond its limit."""
        broken = self.row.note(limit, value, where, excused)
        if broken:
            self.broken.append("%s, %.1f s after begin" % (broken, time.monotonic() - self.begun))

    def hold(self):
        """Fails where something was beyond its limit."""
        print(self.row.row["name"], json.dumps(self.row.worst), flush=True)
        self.assertEqual(self.broken, [])

    def note_ended(self, before, but=(), where=""):
        """How many modules have ended since restarts() gave `before`."""
        after = self.head.restarts(but)
        ended = {n: after[n] - k for n, k in before.items() if n in after and after[n] != k}
        self.note("ended", sum(ended.values()), "%s %s" % (where, ended or ""))

    def note_halt(self, moment, waits, where=""):
        """When the head has come to rest, after a moment [ns]."""
        self.note_time("halts", moment, self.head.motion.rests_at(moment), waits, where)

    def note_time(self, limit, begin, end, waits, where=""):
        """From one moment to another [ns]. What processes waited for meanwhile is excused."""
        waited = waits.until(end)
        where += " beside others who had the processor for %.3f s" % waited
        self.note(limit, (end - begin) / 1e9, where.strip(), waited)


class Safety(Rows):
    """Rows that are tried on one head, one after the other; it has small images, unless these are
    tried for as long as the table says."""

    begin = {} if IS_FULL else dict(SMALL, is_calibrated=False)  # arguments of Head.begin()

    @classmethod
    def setUpClass(cls):
        cls.head = Head()
        cls.addClassCleanup(cls.head.doCleanups)
        cls.head.begin(**cls.begin)

    def setUp(self):
        if self.head.process.poll() is not None:
            self.fail("the head has ended: " + self.head.said()[-2000:])
        self.head.settle()
        super().setUp()
