#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A task of the simulated head is recorded whole; what single modules make of the recording is what
they made then."""

import pathlib
import unittest

from harness import Pipes, ROOT


class Recording(Pipes):
    def messages(self, name):
        """The messages of a recording by their times: header without src, and the elements."""
        data = pathlib.Path(self.path(name)).read_bytes()
        found, at = {}, 0
        while at < len(data):
            end = data.index(b"\n", at)
            header = data[at:end].split()
            # The size of the elements is known where they are binary, else they are text.
            width, height, info = int(header[9]), int(header[10]), int(header[6])
            if info % 10 == 1:
                component_bytes = {0: 1, 3: 2, 8: 4, 9: 8}[info // 10 % 10]
                size = width * height * (info // 100 % 100) * component_bytes
                stop = end + 1 + size
            else:
                stop = end
                for _ in range(height):
                    stop = data.index(b"\n", stop + 1)
            found[int(header[5])] = (header[2:3] + header[6:7] + header[8:], data[end:stop])
            at = stop + 1
        return found

    def assert_same(self, recorded, replayed, at_least):
        recorded, replayed = self.messages(recorded), self.messages(replayed)
        common = [time for time in recorded if time in replayed]
        self.assertGreaterEqual(len(common), at_least)
        for time in common:
            self.assertEqual(recorded[time][1], replayed[time][1], time)

    def test_a_recorded_task_is_played_into_single_modules(self):
        graph = ROOT / "graphs/score_track.toml"
        self.shell(
            "hc run %s --record kept --set track_score.duration=2 --set head_eyes.rate=10" % graph
        )
        score = [line for line in self.err.splitlines() if "RMS error" in line]
        self.assertEqual(len(score), 1, self.err)
        self.shell("hc blob --in image=kept/head_eyes.left.mtp --out target=ball.mtp")
        self.assert_same("kept/left_ball.target.mtp", "ball.mtp", 10)
        # The simulated eyes see the same again, by where the neck was.
        first = min(self.messages("kept/head_eyes.left.mtp"))
        self.shell(
            "hc simulator --rate 10 --paced=false --count 8 --start %d"
            " --in gaze=kept/head_unit.motion.mtp --out left=left.mtp --out ball=place.mtp" % first
        )
        self.assert_same("kept/head_eyes.ball.mtp", "place.mtp", 3)
        self.assert_same("kept/head_eyes.left.mtp", "left.mtp", 3)
        again = self.shell(
            "hc track_score --duration 2 --in left_pose=kept/head_eyes.left_pose.mtp"
            " --in ball=kept/head_eyes.ball.mtp --in ball_seen=kept/head_eyes.ball_seen.mtp"
            " --out score=again.mtp"
        )
        self.assertEqual(again, "")
        self.assertIn(score[0], self.err)


if __name__ == "__main__":
    unittest.main()
