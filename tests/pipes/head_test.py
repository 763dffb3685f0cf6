#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The tasks of the head in the simulated one, as the graphs score_TASK.toml score them."""

import pathlib
import re
import unittest

from harness import Pipes, ROOT


class Head(Pipes):
    def score(self, task, *settings):
        """Runs graphs/score_TASK.toml with such parameters; gives the line of TASK_score."""
        options = "".join(" --set %s" % setting for setting in settings)
        self.shell("hc run %s/graphs/score_%s.toml%s" % (ROOT, task, options))
        lines = re.findall(r"^%s_score: (.*\d.*)$" % task, self.err, re.M)
        self.assertTrue(lines, self.err)
        return lines[-1]


class Read(Head):
    def test_reads_aloud_without_an_error(self):
        line = self.score("read", "read_score.count=2", "speak.rate=450", "speaker.save=said.wav")
        self.assertRegex(line, r"^character error rate 0\.0 %, seen to spoken .* of 2 texts$")
        said = pathlib.Path(self.path("said.wav")).read_bytes()
        self.assertGreater(len(said), 22050)  # half a second of 16 bits, at least

    def test_what_is_not_read_is_wrong_and_is_told(self):
        line = self.score(
            "read", "read_score.count=2", "read_score.time_out=0.5", "read.confidence=1"
        )
        self.assertIn("character error rate 100.0 %", line)
        self.assertIn("of 2 texts; 2 not spoken in time", line)
        self.assertRegex(self.err, r'read_score: "[A-Z0-9 ]+" was read as ""')


if __name__ == "__main__":
    unittest.main()
