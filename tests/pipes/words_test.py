#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the words of hc mean: ports of running graphs, files and links; what is sent to ports, what
lists them, and what shells complete."""

import json
import os
import socket
import unittest

from graphs import Graphs
from harness import DATA, free_port, wait_until

# A task commands an actor; `direct` does too, without being one.
HEAD = """
[modules.workspace]
inputs.bids = "bidder.bid"
[modules.bidder]
mode = "look"
[modules.task]
program = "relay"
mode = "look"
[modules.direct]
program = "relay"
[modules.actor]
exclusive = ["command"]
inputs.command = ["task.out", "direct.out"]
[modules.before]
program = "relay"
[[modules.task.inputs.in]]
from = "before.out"
[modes]
look = 1
[workspace]
module = "workspace"
"""


class Ports(Graphs):
    def setUp(self):
        super().setUp()
        self.name, self.process = self.run_named("words")
        self.environment["HC_GRAPH"] = self.name

    def refused(self, command, reason, status=2):
        self.shell(command, status)
        self.assertIn(reason, self.err)

    def test_a_port_is_never_taken_for_a_file(self):
        for port in ("camera.left", "brightness.image", "brightness.mean", "brightness.trace"):
            for command in (
                "hc send 1 --out " + port,
                "hc send 1 | hc play --speed max - --out " + port,
                "hc send 1 | hc record " + port,
                "hc record camera.left " + port,
                "hc send --image %s/HappyFish.jpg | hc brightness --out %s" % (DATA, port),
                "hc send --image %s/HappyFish.jpg | hc brightness --out=mean=%s" % (DATA, port),
            ):
                self.refused(command, port + " is a port of a running graph: ")
            self.assertFalse(os.path.exists(self.path(port)), port)

    def test_a_file_of_that_name_has_a_path(self):
        self.shell("hc send 1 --out ./camera.left; hc send 2 --out camera.lefty")
        self.assertEqual(self.shell("hc cat ./camera.left --json").count("\n"), 1)
        self.assertEqual(self.shell("hc cat camera.lefty --json").count("\n"), 1)
        self.assertIn("rgb_image", self.shell("hc cat camera.left --count 1"))

    def test_recordings_are_files_by_their_endings(self):
        self.shell("hc graph add mean brightness; hc graph link camera.left mean.image")
        for name in ("mean.mtp", "camera.mcap"):
            self.shell("hc send 1 | hc record %s; hc info %s" % (name, name))

    def test_all_verbs_read_ports(self):
        self.assertIn("\n2 messages", self.shell("hc info camera.left --count 2"))
        self.assertIn("rgb_image", self.shell("hc play camera.left | hc cat --count 1"))
        self.assertIn("table", self.shell("hc brightness --in camera.left | hc cat --count 1"))
        self.assertIn("table", self.shell("hc brightness camera.left | hc cat --count 1"))
        os.mkdir(self.path("camera.left"))
        self.assertIn("\n2 messages", self.shell("hc info camera.left --count 2"))

    def test_a_port_of_one_of_several_graphs_is_asked_for(self):
        del self.environment["HC_GRAPH"]
        self.shell("cp g.toml other.toml")
        other = self.start("exec hc run other.toml --as other_" + self.name)
        self.await_lines(other, "brightness: started")
        self.addCleanup(self.end_well, other)
        self.refused("hc send 1 --out camera.left", "is a port of a running graph")
        self.refused("hc cat camera.left", "several graphs are running; pass --of NAME")
        self.shell("hc cat camera.left --count 1 --of " + self.name)

    def test_a_link_takes_a_file(self):
        self.shell("hc graph link brightness.mean out.mtp")
        wait_until(lambda: os.path.getsize(self.path("out.mtp")))
        self.shell("hc graph unlink brightness.mean ./out.mtp")
        self.assertIn("table", self.shell("hc cat out.mtp"))

    def test_a_link_that_cannot_be_opened_is_an_error(self):
        port = free_port()
        self.refused("hc graph link tcp:%d brightness.image" % port, "Connection refused")
        self.refused("hc graph link camera.left tcp:%d" % port, "Connection refused")
        self.refused("hc graph link camera.left unix:no/such", "No such file or directory")
        links = self.state_of(self.process, self.name)["links"]
        self.assertEqual([each["to"] for each in links], ["brightness.image"])
        with socket.socket() as listening:
            listening.bind(("127.0.0.1", 0))
            listening.listen()
            place = "tcp:%d" % listening.getsockname()[1]
            self.shell("hc graph link camera.left " + place)
            with listening.accept()[0] as reader:
                self.assertTrue(reader.recv(1))
            self.shell("hc graph unlink camera.left " + place)

    def test_a_link_to_a_file_that_cannot_be_written_is_an_error(self):
        self.refused("hc graph link camera.left no/such/x.mtp", "No such file or directory")
        links = self.state_of(self.process, self.name)["links"]
        self.assertEqual([each["to"] for each in links], ["brightness.image"])
        self.stop(self.process, 1)  # the error is repeated at the end

    def test_a_message_is_sent_to_an_input(self):
        self.shell("hc graph unlink camera.left brightness.image")
        reader = self.start("exec hc cat brightness.mean --json --count 1 >mean")
        image = "hc send --image %s/HappyFish.jpg --to brightness.image" % DATA

        def has_come():
            self.shell(image)
            return reader.poll() is not None

        wait_until(has_come)
        mean = json.loads(self.read("mean"))["elements"][0][0]
        self.assertTrue(0 < mean < 255, mean)
        links = self.state_of(self.process, self.name)["links"]
        self.assertEqual(links, [])

    def test_what_an_input_does_not_take_is_refused(self):
        takes = " does not fit, the port takes rgb_image of 3 x u8 or intensity_image of 1 x u8"
        for words, sent in (
            ("1 2 --type table", "table 2 x 1 of 1 x f64"),
            ("1 2 --type intensity_image --scalar f32", "intensity_image 2 x 1 of 1 x f32"),
            ("1 2 3 --scalar f32", "rgb_image 1 x 1 of 3 x f32"),
        ):
            self.shell("hc send %s --to brightness.image" % words, 1)
            self.assertIn("brightness.image: " + sent + takes, self.err)
        for words in (
            "1 2 3 4 5 6 --width 2",
            "1 2 3 4 5 6 --width 2 --type rgb_image",
            "1 2 3 4 --width 2 --components 1",
        ):
            self.shell("hc send %s --to brightness.image" % words)
        for to, reason in (
            ("brightness.imag", 'no input "brightness.imag", did you mean "brightness.image"?'),
            ("brightness.mean", 'no input "brightness.mean"'),
            ("tcp:7000", "--to needs MODULE.PORT of a running graph"),
            ("brightness.focus", "decides on the focus"),
        ):
            self.refused("hc send 1 --to " + to, reason)
        reason = "brightness.image takes an image, and numbers alone do not say of what size"
        self.refused("hc send 1 2 3 --to brightness.image", reason)
        self.refused("hc send 1 --mode 3 --to brightness.image", "--to and --mode exclude")
        self.refused("hc send 1 --out x.mtp --to brightness.image", "excludes")

    def test_ports_are_listed(self):
        table = self.shell("hc ports")
        self.assertRegex(table, r"(?m)^camera.left +out  rgb_image .*: ")
        self.assertRegex(table, r"\nbrightness.image +in   rgb_image .* or intensity_image .*: ")
        self.assertEqual(table, self.shell("hc ports g.toml"))
        lines = [json.loads(line) for line in self.shell("hc ports --json").splitlines()]
        image = next(each for each in lines if each["name"] == "brightness.image")
        self.assertEqual(image["kind"], "input")
        self.assertEqual(image["types"][0]["type"], "rgb_image")
        self.assertEqual(len(lines), table.count("\n"))
        own = self.shell("hc ports brightness --of " + self.name)
        self.assertRegex(own, r"^brightness.image +in .*\nbrightness.mean +out  table")
        self.refused("hc ports brightniss --of " + self.name, 'did you mean "brightness"')
        self.assertRegex(self.shell("hc ports brightness"), "^image +in   .*\nmean +out  table")
        self.assertRegex(self.shell("hc ports depth.toml"), r"\ndepth.depth +out  ")
        # Neither /usr/bin/head, nor the graph depth.toml.
        self.assertRegex(self.shell("hc ports head"), "^workspace.bids +in  ")
        self.assertRegex(self.shell("hc ports depth"), r"\ndepth +out  ")
        self.refused("hc ports brightniss", 'no graph or program "brightniss", did you mean', 1)

    def complete(self, *words):
        command = " ".join("'%s'" % word for word in words)
        return self.shell("hc complete -- " + command).split()

    def test_shells_complete_what_runs(self):
        self.assertIn(self.name, self.complete("top", "--of", ""))
        self.assertIn("camera.left", self.complete("cat", ""))
        self.assertIn("camera.left", self.complete("view", "--in", ""))
        self.assertIn("brightness.image", self.complete("send", "1", "--to", ""))
        self.assertIn("camera.rate=", self.complete("graph", "set", ""))
        self.assertIn("camera", self.complete("graph", "restart", ""))
        self.assertEqual(
            self.complete("graph", "unlink", "camera.left", ""),
            ["camera.left", "brightness.image"],
        )
        self.assertIn("brightness.image", self.complete("graph", "link", "camera.left", ""))
        for words in (("run", ""), ("check", ""), ("graph", "")):
            self.assertIn("score_track", self.complete(*words))
        self.assertIn("--rate", self.complete("camera", "--"))
        self.assertIn("--of", self.complete("graph", "set", "--"))
        self.assertIn("brightness", self.complete("graph", "add", "x", ""))


class Focus(Graphs):
    def test_nothing_moves_but_by_a_task(self):
        name, _ = self.run_named("focus", HEAD, "started")
        of = " --of " + name
        for to in ("actor.command", "workspace.bids", "task.focus"):
            self.assertRegex(
                self.hc("send 0 0 0 --to " + to + of, 2),
                to + " (obeys the task in focus only|decides on the focus)",
            )
        self.assertIn(
            "direct.in leads to actor.command", self.hc("send 0 0 0 --to direct.in" + of, 2)
        )
        for to in ("task.in", "before.in"):
            self.hc("send 0 0 0 --to " + to + of)


if __name__ == "__main__":
    unittest.main()
