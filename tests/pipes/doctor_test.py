#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""hc doctor on this machine, and on graphs that miss something."""

import os
import re
import socket
import unittest

from harness import DATA, Pipes, ROOT

GRAPH = """version = 1
[modules.camera]
parameters.source = "%s"
[modules.brightness]
inputs.image = "camera.left"
"""


class Doctor(Pipes):
    def examine(self, text, status, options=""):
        """What is said of a graph: marks, and lines of each."""
        self.write("g.toml", text)
        said = {}
        for line in self.shell("hc doctor g.toml" + options, status).splitlines():
            mark, text = line.split(maxsplit=1)
            said.setdefault(mark, []).append(re.sub(" +", " ", text))
        return said

    def test_this_machine_can_run_graphs(self):
        out = self.shell("hc doctor")
        for line in out.splitlines():
            self.assertRegex(line, "^(ok     |note   )  [a-z]+ +[^ ]")
        self.assertRegex(out, "ok +kernel +Linux .*memfd with seals, pidfd, membarrier, futex")
        self.assertRegex(out, "ok +modules +.*brightness, .*camera")
        self.assertRegex(out, "ok +networks +face_detection_full_range, .*palm_detection_lite\n")
        self.assertRegex(out, "note +display +none")

    def test_a_graph_that_misses_nothing(self):
        self.environment["HC_DATA"] = DATA
        out = self.shell("hc doctor %s/graphs/depth.toml" % ROOT)
        self.assertRegex(out, r"ok +graph +.*depth\.toml: no problems found")
        self.assertRegex(out, r"ok +camera +parameter source: .*/aloeL\.jpg\n")

    def test_files_that_are_not_there_or_may_not_be_read(self):
        said = self.examine(GRAPH % "./none.jpg", 1)
        self.assertEqual(said["missing"], ["camera parameter source: ./none.jpg does not exist"])
        said = self.examine(GRAPH % "./none.jpg", 1, " --set camera.source=/none/a.jpg")
        self.assertEqual(said["missing"], ["camera parameter source: /none/a.jpg does not exist"])
        os.mkdir(self.path("images"))
        self.assertNotIn("missing", self.examine(GRAPH % "./images", 0))
        self.assertNotIn("missing", self.examine(GRAPH % "rtsp://robot/left", 0))

    def test_ports_in_use(self):
        outside = '[[modules.camera.outputs.left]]\nto = "tcp-listen:%d"\n'
        with socket.create_server(("127.0.0.1", 0)) as server:
            text = GRAPH % "0" + outside % server.getsockname()[1]
            self.assertRegex(
                self.examine(text, 1)["missing"][0], "camera link tcp-listen:.* in use"
            )
        self.assertNotIn("missing", self.examine(text, 0))

    def test_a_window_wants_a_display(self):
        text = GRAPH % "0" + '[modules.view]\ninputs.image = "camera.left"\n'
        self.assertRegex(self.examine(text, 1)["missing"][0], "^view a display")
        self.assertNotIn("missing", self.examine(text, 0, " --set view.save=a.png"))

    def test_what_is_wrong_with_a_graph_is_said_as_check_does(self):
        said = self.examine(GRAPH.replace("source", "sorce").replace(".image", ".imag") % "0", 1)
        self.shell("hc check g.toml", 2)
        got = [line.split("error: ")[1] for line in self.err.splitlines()]
        self.assertEqual(said["wrong"], ["graph " + line for line in got])
        self.assertEqual(len(got), 2)
        self.assertEqual(self.shell("hc doctor none.toml", 1), "")
        self.assertEqual(
            self.err, "hc doctor: NotFound: none.toml: cannot be read: No such file or directory\n"
        )


if __name__ == "__main__":
    unittest.main()
