#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""graphs/clocked_track.toml: a closed loop in the time of its images does the same in each run."""

import math
import os
import unittest

from harness import Pipes, ROOT
from recordings import read_messages

GRAPH = (
    """version = 1
[graphs.head]
file = "%s/graphs/clocked_track.toml"
modules.eyes.parameters = { count = 61, width = 400, height = 300, focal = 300, seed = SEED }
modules.eyes.outputs.left = "file:left.mtp"
modules.ball.outputs.area = "file:area.mtp"
modules.track.parameters = { focal = 300, cx = 199.5, cy = 149.5 }
modules.track.outputs.command = "file:command.mtp"
modules.track_score.parameters.duration = 3
modules.track_score.outputs.score = "file:score.mtp"
"""
    % ROOT
)
FILES = ["left.mtp", "area.mtp", "command.mtp", "score.mtp"]


class Clocked(Pipes):
    def sent(self, seed, run="hc run"):
        """What the modules of a run have sent, by file."""
        self.write("g.toml", GRAPH.replace("SEED", str(seed)))
        self.shell(run + " g.toml --quiet")
        sent = {name: self.read_bytes(name) for name in FILES}
        for name in FILES:
            os.remove(self.path(name))
        return sent

    def test_each_run_sends_the_same_bytes(self):
        first, other = self.sent(1), self.sent(2)
        self.assertEqual([name for name in FILES if first[name] == other[name]], [])
        # On one processor, which is busy with something else, the modules run in another order.
        for _ in range(2):
            self.start("exec taskset -c 0 yes", stdout=-3)
        again = self.sent(1, "taskset -c 0 hc run")
        self.assertEqual([name for name in FILES if first[name] != again[name]], [])

    def test_a_replay_of_its_modules_sends_the_same(self):
        self.write("g.toml", GRAPH.replace("SEED", "1"))
        self.shell("hc run g.toml --quiet --record kept")
        out = self.shell("hc replay kept --graph g.toml --check")
        for name in ("ball.target", "track.command"):
            self.assertRegex(out, "head_%s: [0-9]{2,} messages, the same" % name)

    def test_the_loop_is_closed(self):
        self.write("g.toml", GRAPH.replace("SEED", "1"))
        self.shell("hc run g.toml --quiet")
        images, commands = (
            [message.time for message in read_messages(self.path(name))]
            for name in ("left.mtp", "command.mtp")
        )
        self.assertEqual(images, [10**9 + i * 5 * 10**7 for i in range(61)])
        # Each 10 ms from the first that follows an image on, and for each image.
        self.assertEqual(sorted(set(commands)), list(range(commands[0], images[-1] + 1, 10**7)))
        score = self.recorded("score.mtp")[0].rows[0]
        self.assertLess(math.degrees(score[0]), 2)
        self.assertGreater(score[4], 50)  # images in which the ball was followed


if __name__ == "__main__":
    unittest.main()
