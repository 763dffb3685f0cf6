#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Modules in Python in graphs, beside modules in C++; and graphs seen from Python."""

import os
import signal
import unittest
from types import SimpleNamespace
from unittest import mock


from package import Package, WATCHDOG, hc, wait_until

from harness import DATA

FILTER = """
import hypercolumn as hc
module = hc.Module("darken", "Darkens images.")
image = module.input("image", hc.rgb_image(), "an image")
dark = module.output("dark", hc.rgb_image(), "the same, darker")
never = module.output("never", hc.rgb_image(), "nothing")
shift = module.parameter("shift", 1, "", "how much", min=0, max=7)
module.parameter("title", "2.5", "", "any text")
module.parameter("gain", 1.0, "", "any number")

@module.on(image)
def darken(message):
    with dark.loan(message.height, message.width) as out:
        out[:] = message.matrix >> shift.value

module.run()
"""
GRAPH = (
    """
version = 1
[modules.camera]
parameters = { source = "%s/HappyFish.jpg", loop = true, rate = 50, width = 80, height = 60 }
[modules.darken]
program = "./darken"
inputs.image = "camera.left"
[modules.brightness]
inputs.image = "darken.dark"
"""
    % DATA
)


class Graphs(Package):
    def setUp(self):
        super().setUp()
        self.environment.pop("PYTHONPATH")  # hc has modules find the package
        os.environ["PATH"], path = self.environment["PATH"], os.environ["PATH"]
        self.addCleanup(os.environ.__setitem__, "PATH", path)
        # In which a module has to report a new value: not so soon on a busy machine.
        patience = mock.patch("hypercolumn.graphs._REPORT", WATCHDOG)
        patience.start()
        self.addCleanup(patience.stop)
        self.write_module("darken", FILTER)
        self.write("g.toml", GRAPH)
        self.graph = self.path("g.toml")

    def test_check_knows_its_ports(self):
        self.assertIn("no problems found", self.shell("hc check g.toml"))
        self.write("wrong.toml", GRAPH.replace("darken.dark", "darken.drak"))
        self.shell("hc check wrong.toml", 2)
        self.assertIn('did you mean "dark"?', self.err)

    def test_images_go_from_cpp_to_python_to_cpp(self):
        with hc.start(self.graph) as graph:
            running = lambda: [each.status for each in graph.modules.values()] == ["running"] * 3
            wait_until(running)
            bright = graph["camera.left"].read().matrix.mean()
            for message in graph["brightness.mean"]:
                if message.numbers[0] > 0:
                    break
            self.assertLess(message.numbers[0], 0.6 * bright)
            links = {(each.source, each.target): each for each in graph.links}
            self.assertEqual(links[("darken.dark", "brightness.image")].transport, "shm")

    def test_parameters_are_set_while_it_runs(self):
        with hc.start(self.graph) as graph:
            self.assertEqual(graph.parameters["darken.shift"], 1)
            self.assertEqual(graph.parameters["camera.loop"], True)
            self.assertIn("HappyFish", graph.parameters["camera.source"])
            graph.parameters["darken.shift"] = 7
            self.assertTrue(any(m.numbers[0] < 2 for m in graph["brightness.mean"]))
            wait_until(lambda: graph.parameters["darken.shift"] == 7)
            with self.assertRaisesRegex(hc.Error, "darken.shift|8"):
                graph.parameters["darken.shift"] = 8
            with self.assertRaises(KeyError):
                graph.parameters["darken.no"]

    def test_parameters_are_of_their_types(self):
        with hc.start(self.graph) as graph:
            parameters = graph.parameters
            for value in ("5", "true", "text"):
                parameters["darken.title"] = value
                self.assertEqual(parameters["darken.title"], value)
            for value in ("3", 4):
                parameters["darken.shift"] = value
                self.assertEqual(parameters["darken.shift"], int(value))
            parameters["darken.gain"] = 2
            self.assertIsInstance(parameters["darken.gain"], float)
            self.assertEqual(parameters["darken.gain"], 2.0)
            os.kill(graph.modules["darken"].pid, signal.SIGSTOP)
            soon = mock.patch("hypercolumn.graphs._REPORT", 2.0)
            with soon, self.assertRaisesRegex(hc.Error, "darken.shift=5 was sent") as caught:
                parameters["darken.shift"] = 5
            self.assertEqual(caught.exception.code, "Closed")
            os.kill(graph.modules["darken"].pid, signal.SIGCONT)

    def test_a_graph_that_ends_meanwhile_is_an_error(self):
        self.write("ended.mtp", b"")
        uri = "file:" + self.path("ended.mtp")
        graph = hc.Graph(SimpleNamespace(name="g", process=1, state_uri=uri))
        with self.assertRaises(hc.Error) as caught:
            graph.modules
        self.assertEqual(caught.exception.code, "Closed")

    def test_a_port_is_read_without_disturbing(self):
        with hc.start(self.graph) as graph:
            seen = []
            for message in graph["darken.dark"]:
                seen.append(message.seq)
                self.assertEqual(message.matrix.shape, (60, 80, 3))
                if len(seen) == 5:
                    break
            self.assertEqual(seen, sorted(set(seen)))
            with self.assertRaisesRegex(hc.Error, "no"):
                graph["darken.no"].read()

    def test_reading_ends_after_a_time(self):
        with hc.start(self.graph) as graph:
            self.assertEqual(graph["darken.dark"].read(60).matrix.shape, (60, 80, 3))
            with self.assertRaisesRegex(hc.Error, "darken.never: no message in 0.1 s") as caught:
                graph["darken.never"].read(0.1)
            self.assertEqual(caught.exception.code, "Closed")

    def test_reading_ends_with_the_graph(self):
        with hc.start(self.graph) as graph:
            seen = 0
            for message in graph["camera.left"]:
                if seen == 0:
                    graph.command("stop")
                seen += 1
            self.assertGreater(seen, 0)

    def test_attach_finds_it_by_its_name(self):
        os.environ.pop("HC_GRAPH", None)
        with hc.start(self.graph, "--as", "garden") as graph:
            self.assertEqual(hc.attach("garden").process, graph.process)
            self.assertIn("garden", [each.name for each in hc.running()])
            with self.assertRaisesRegex(hc.Error, 'no graph "gardn" is running'):
                hc.attach("gardn")
        wait_until(lambda: "garden" not in [each.name for each in hc.running()])

    def test_a_graph_that_cannot_run_says_why(self):
        self.write("wrong.toml", GRAPH.replace("./darken", "./no_such"))
        with self.assertRaisesRegex(hc.Error, "no_such") as caught:
            with hc.start(self.path("wrong.toml")):
                pass
        self.assertEqual(caught.exception.code, "Invalid")

    def test_an_exception_is_in_the_log_of_the_graph(self):
        self.write_module("darken", FILTER.replace(">> shift.value", "/ 0 * no_such_name"))
        self.write("g.toml", GRAPH.replace('"./darken"', '"./darken"\nrestart = "never"'))
        self.shell("timeout 60 hc run g.toml", 1)
        self.assertIn("darken: NameError: name 'no_such_name' is not defined", self.err)
        self.assertIn("Traceback", self.err)


if __name__ == "__main__":
    unittest.main()
