#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The tasks of the head in the simulated one, as the graphs score_TASK.toml score them."""

import math
import os
import pathlib
import re
import shutil
import unittest

from harness import Pipes, ROOT, WATCHDOG, wait_until


class Head(Pipes):
    def score(self, task, *settings):
        """Runs graphs/score_TASK.toml with such parameters; gives the line of TASK_score."""
        options = "".join(" --set %s" % setting for setting in settings)
        self.shell("hc run %s/graphs/score_%s.toml%s" % (ROOT, task, options))
        lines = re.findall(r"^%s_score: (.*\d.*)$" % task, self.err, re.M)
        self.assertTrue(lines, self.err)
        return lines[-1]

    def track_error(self):
        """How well the head followed the ball, as track_score said [°]."""
        error = re.search(r"track_score: RMS error (\S+)°, acquired after \S+ s", self.err)
        self.assertTrue(error, self.err)
        return float(error[1])


class Whole(Head):
    """graphs/head.toml, with a head that is crooked and has its eyes swapped."""

    CROOKED = {
        "swapped": "true",
        "zero_pan": 0.05,
        "zero_tilt": -0.04,
        "offset_pitch": 0.015,
        "offset_yaw": -0.015,
    }
    FOUND = "zero_pan", "zero_tilt", "offset_roll", "offset_pitch", "offset_yaw"

    def test_it_calibrates_itself_and_follows_the_ball(self):
        self.write(
            "whole.toml",
            """
            version = 1
            [graphs.robot]
            file = "%s/graphs/head.toml"
            [modules.track_score]
            ends_graph = true
            [[modules.track_score.inputs.begin]]
            from = "robot_calibrate.result"
            """
            % ROOT
            + "".join(
                '[[modules.track_score.inputs.%s]]\nfrom = "robot_head_eyes.%s"\n' % (port, port)
                for port in ("left_pose", "ball", "ball_seen")
            ),
        )
        options = {"track_score.duration": 20, "robot_web.port": 0}
        options["robot_head_eyes.rate"] = 10  # a busy machine has time for so many images
        options |= {"robot_head_eyes.%s" % name: value for name, value in self.CROOKED.items()}

        self.shell("hc run whole.toml" + "".join(" --set %s=%s" % each for each in options.items()))
        found = re.search(
            r"calibrate: cameras swapped; gaze offset pan (\S+)°, tilt (\S+)°; "
            r"right-to-left rotation roll (\S+)°, pitch (\S+)°, yaw (\S+)°",
            self.err,
        )
        self.assertTrue(found, self.err)
        wrong = [self.CROOKED.get(name, 0) for name in self.FOUND]
        for angle, truth in zip(found.groups(), wrong):
            self.assertAlmostEqual(float(angle), math.degrees(truth), delta=0.4)
        # It is 18 degrees and more if track does not know how its eyes sit.
        self.assertLess(self.track_error(), 10)


class EyesElsewhere(Head):
    """Eyes that the graph file has mounted elsewhere: in the simulation and in the control."""

    PLACES = {
        "[0.06, 0.05, 0.05]": "[0.03, 0.09, 0.12]",
        "[0.06, -0.05, 0.05]": "[0.01, -0.07, 0.1]",
    }

    def setUp(self):
        super().setUp()
        shutil.copytree(ROOT / "graphs", self.path("graphs"))
        file = pathlib.Path(self.path("graphs/simulated_head.toml"))
        text = file.read_text()
        for mounted, elsewhere in self.PLACES.items():
            self.assertIn(mounted, text)
            text = text.replace(mounted, elsewhere)
        file.write_text(text)

    def test_are_calibrated(self):
        faults = "".join(
            " --set %s.%s=%s" % (module, *each)
            for module in ("head_eyes", "calibrate_score")
            for each in Whole.CROOKED.items()
        )
        self.shell("hc run graphs/score_calibrate.toml" + faults)
        found = re.search(
            r"identified correctly, zero off by (\S+)°, camera offset by (\S+)°", self.err
        )
        self.assertTrue(found, self.err)
        for error in found.groups():
            self.assertLess(float(error), 0.4)

    def test_look_at_the_ball(self):
        # A ball at rest: it is where the eyes are that counts, and not how fast the machine is.
        settings = ["track_score.duration=8", "track_score.within=0.01", "head_eyes.ball=still"]
        graph = "graphs/score_track.toml" + "".join(" --set " + setting for setting in settings)
        self.shell("hc run --record kept " + graph)
        self.assertRegex(self.err, r"track_score: RMS error \S+°, acquired after \S+ s, came")
        # The truth is that of the file.
        first = self.shell("hc cat --raw kept/head_eyes.left_pose.mtp | sed -n 2,5p").splitlines()
        height = float(first[2].split()[3])
        self.assertGreater(height, 1.2 + 0.1)  # 0.05 above the unit by default


class Marker(Head):
    """graphs/track_marker.toml: the head looks at a coloured marker, by its pose."""

    def test_the_head_turns_to_it(self):
        graph = (ROOT / "graphs/track_marker.toml").read_text()
        graph = graph.replace("simulated_head.toml", str(ROOT / "graphs/simulated_head.toml"))
        for port in ("left_pose", "markers"):
            graph = graph.replace(
                "[modes]",
                '[graphs.head.modules.eyes.outputs.%s]\nto = "file:%s"\n\n[modes]' % (port, port),
            )
        self.write("graph.toml", graph)
        process = self.start("exec hc run graph.toml 2>said")

        def looks_at(marker, T):  # T_world_left_eye
            to = [marker[3 + i] - T[i][3] for i in range(3)]
            ahead = sum(T[i][2] * to[i] for i in range(3)) / math.hypot(*to)
            # The left eye is 0.05 m off the middle, 1 degree at this distance.
            return ahead > math.cos(math.radians(2.5))

        def rests_on_it():
            markers = [row for row in self.rows("markers") if row[:2] == [2, 300]]
            poses = [each.rows for each in self.recorded("left_pose")][-20:]
            return (
                markers and len(poses) == 20 and all(looks_at(markers[0], pose) for pose in poses)
            )

        wait_until(rests_on_it)
        process.terminate()
        process.communicate(timeout=WATCHDOG)
        self.assertEqual(process.returncode, 0, self.read("said"))


class CalibrationFile(Head):
    """What is found is kept, and taken from the file the next time."""

    def run_crooked(self, graph, *settings):
        settings = ["head_eyes.%s=%s" % each for each in Whole.CROOKED.items()] + list(settings)
        options = "".join(" --set %s" % setting for setting in settings)
        self.shell("hc run %s/graphs/%s.toml%s" % (ROOT, graph, options))
        return self.err

    def test_is_written_once_and_used_by_all(self):
        first, second = (
            self.run_crooked("score_calibrate", "calibrate.calibration_file=cal.yml")
            for _ in range(2)
        )
        found = re.search(r"calibrate: (cameras swapped; .*)", first)
        self.assertTrue(found, first)
        self.assertIn("calibrate: from cal.yml: " + found[1], second)

        self.run_crooked("score_track", "track.calibration_file=cal.yml", "track_score.duration=4")
        # Without the file it is 18 degrees and more.
        self.assertLess(self.track_error(), 10)
        self.shell(
            "hc simulator --count 1 --paced=false --start 1000000000 --in gaze=/dev/null"
            " --out left=l.mtp --out right=r.mtp;"
            " hc rectify cal.yml --in left=l.mtp --in right=r.mtp --out left=rectified.mtp"
        )
        # Swapped: what the right camera's cable brings is the left eye's.
        self.assertGreater(len(self.read_bytes("rectified.mtp")), 3 * 800 * 600)


class People(Head):
    """graphs/score_identity.toml and score_stop.toml: persons in the simulated room."""

    def test_everybody_gets_a_name(self):
        self.shell(
            "HC_PEOPLE=people hc run %s/graphs/score_identity.toml --set head_eyes.people_motion=still"
            " --set identity_score.names_people=true --set identity_score.duration=300" % ROOT
        )
        self.assertEqual(set(os.listdir(self.path("people"))), {"1", "2"})

    def test_stops_are_counted(self):
        line = self.score("stop", "stop_score.duration=12", "head_eyes.people=1")
        counted = re.match(r"missed (\d+) of (\d+) palms, .*; 0 stops without a palm, ", line)
        self.assertTrue(counted, line)
        self.assertLess(int(counted[1]), int(counted[2]))


class Read(Head):
    def test_reads_aloud_without_an_error(self):
        settings = ["read_score.count=2", "read_score.time_out=60", "speak.rate=450"]
        line = self.score("read", *settings, "speaker.save=said.wav")
        self.assertRegex(line, r"^character error rate 0\.0 %, seen to spoken .* of 2 texts$")
        said = pathlib.Path(self.path("said.wav")).read_bytes()
        self.assertGreater(len(said), 22050)  # half a second of 16 bits, at least

    def test_what_is_not_read_is_wrong_and_is_reported(self):
        line = self.score(
            "read", "read_score.count=2", "read_score.time_out=0.5", "read.confidence=1"
        )
        self.assertIn("character error rate 100.0 %", line)
        self.assertIn("of 2 texts; 2 not spoken in time", line)
        self.assertRegex(self.err, r'read_score: "[A-Z0-9 ]+" was read as ""')


if __name__ == "__main__":
    unittest.main()
