#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Two simulated heads beside each other, in one folder: each keeps its figures, and its files.

The bounds of the figures are those that only a head exceeds which somebody else moves: one that
follows the person of the other graph is off by 28° and more.
"""

import os
import re
import unittest

from graphs import Graphs
from harness import ROOT, WATCHDOG, if_quick

# A score: its line, what is set to make it short, and whether its figures are right.
SCORES = {
    "telepresence": (
        r"follow_score: error ([\d.]+)° RMS",
        ["follow_score.duration=4"],
        lambda rms: rms < 15,
    ),
    "track": (
        r"track_score: RMS error ([\d.]+)°",
        ["track_score.duration=4"],
        lambda rms: rms < 15,
    ),
    "read": (r"read_score: character error rate ([\d.]+) %", [], lambda rate: rate == 0),
}


class SideBySide(Graphs):
    def start_score(self, score, *parameters):
        sets = "".join(" --set " + each for each in (*SCORES[score][1], *parameters))
        return self.start("exec hc run %s/graphs/score_%s.toml%s" % (ROOT, score, sets))

    def assert_right(self, score, process):
        """Waits for the end of a score, whose figures are those of one that is alone."""
        _, err = process.communicate(timeout=WATCHDOG)
        self.assertEqual(process.returncode, 0, err)
        found = re.search(SCORES[score][0], err.decode())
        self.assertTrue(found, err.decode()[-3000:])
        self.assertTrue(SCORES[score][2](*map(float, found.groups())), (score, found[0]))

    def assert_both_are_right(self, one, other, *parameters_of_other):
        running = self.start_score(one), self.start_score(other, *parameters_of_other)
        self.assert_right(one, running[0])
        self.assert_right(other, running[1])
        self.assertEqual(os.listdir(self.folder.name), [])

    def test_two_persons_who_turn_their_heads_to_different_sides(self):
        self.assert_both_are_right("telepresence", "telepresence", "fake_head_tracker.seed=3")

    def test_a_ball_and_a_text(self):
        self.assert_both_are_right("track", "read")

    @if_quick
    def test_the_head_hears_no_tracker_of_a_score(self):
        self.environment.update(HC_HEAD_TRACKER="0", XDG_STATE_HOME=self.folder.name + "/state")
        head = self.start(
            "exec hc run %s/graphs/head.toml --set web.port=0 --set head_eyes.rate=2" % ROOT
        )
        self.await_lines(head, "head_tracker: listening on UDP")
        self.assert_right("telepresence", self.start_score("telepresence"))
        links = self.state_of(head, "head")["links"]
        from_tracker = [
            link["messages"] for link in links if link["from"] == "head_tracker.rotation"
        ]
        self.assertEqual(from_tracker, [0])
        self.stop(head)
        self.assertLessEqual(set(os.listdir(self.folder.name)), {"state"})


if __name__ == "__main__":
    unittest.main()
