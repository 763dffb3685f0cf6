#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Values of parameters that no restart would cure: each ends its module with status 2."""

import subprocess
import unittest

from graphs import Graphs
from harness import wait_until

# A module, its parameters, and the one that is refused: a value, or a file that is missing, broken,
# or in a place that cannot be.
REFUSED = (
    ("augment", "--objects=x", "objects"),
    ("augment", "--objects='broken.gltf at world 0 0 0 size 1'", "objects"),
    ("augment", "--instruments=x", "instruments"),
    ("calibrate", "--calibration_file=broken", "calibration_file"),
    ("camera", "none.jpg", "none.jpg"),
    ("camera", "broken.avi", "broken.avi"),
    ("camera", "plain/x.png", "plain/x.png"),
    ("gateway", "--numbers=x", "x"),
    ("gaze", "--calibration_file=none", "calibration_file"),
    ("gaze", "--calibration_file=broken", "calibration_file"),
    ("gaze", "--frames=x", "frames"),
    ("head_tracker", "x", "x"),
    ("marker", "--calibration_file=none", "calibration_file"),
    ("marker", "--calibration_file=broken", "calibration_file"),
    ("marker", "--dictionary=x", "dictionary"),
    ("marker", "--marker_frames=x", "x"),
    ("microphone", "--file=none.wav", "file"),
    ("microphone", "--file=broken", "file"),
    ("microphone", "--rate=1", "rate"),
    ("read", "--language=x", "x"),
    ("recorder", "--file=plain/x.mcap", "file"),
    ("recorder", "--file=none/x.mcap", "file"),
    ("recorder", "--folder=plain/x", "folder"),
    ("rectify", "--calibration_file=none", "calibration_file"),
    ("rectify", "--calibration_file=broken", "calibration_file"),
    ("rectify", "--calibration_file=/", "calibration_file"),
    ("simulator", "--frames=x", "frames"),
    ("stereo_calibration", "--calibration_file=broken", "calibration_file"),
    (
        "stereo_calibration",
        "--board=charuco --square=2 --marker_size=1 --dictionary=x",
        "dictionary",
    ),
    ("stereo_calibration", "--print=plain/x.pdf", "print"),
    ("view", "--window=no --save=x.mtp", "save"),
    ("view", "--window=no --save=x.png --min=2 --max=1", "min"),
    ("workspace", "--stops=x", "stops"),
)


class Parameters(Graphs):
    def setUp(self):
        super().setUp()
        for name in ("plain", "broken", "broken.avi", "broken.gltf"):
            self.write(name, "no such thing\n")

    def test_what_cannot_be_used_is_invalid(self):
        for module, given, named in REFUSED:
            with self.subTest(module + " " + given):
                self.shell("hc %s %s </dev/null >/dev/null" % (module, given), 2)
                line = self.err.splitlines()[-1]
                self.assertIn(module + ": Invalid: ", line)
                self.assertIn(named, line)

    def test_a_graph_does_not_start_such_a_module_again(self):
        self.write(
            "g.toml",
            "version = 1\n[modules.rectify]\nparameters.calibration_file = 'none'\n"
            "[modules.marker]\nparameters.dictionary = 'x'\n",
        )
        self.shell("hc run g.toml", 1)
        for module in ("rectify", "marker"):
            self.assertIn(module + ": failed with status 2", self.err)
            self.assertEqual(self.err.count(module + ": Invalid: "), 1, self.err)

    def test_a_device_that_is_not_plugged_in_is_waited_for(self):
        process = self.start("exec hc pan_tilt /dev/none 2>log", stdin=subprocess.PIPE)
        self.addCleanup(self.end, process)
        wait_until(lambda: "/dev/none" in self.read("log"))
        self.assertIsNone(process.poll())


if __name__ == "__main__":
    unittest.main()
