#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""hc replay: the modules of a recorded graph run again, and what they send is compared."""

import re
import unittest

from harness import Pipes, ROOT
from recordings import read_messages
from trace_test import graph

OPTIONS = " --graph g.toml --check"


class Replay(Pipes):
    def record(self, text=graph("0:1 2:end")):
        self.write("g.toml", "version = 1\n" + text)
        self.shell("hc run g.toml --quiet --record kept")

    def test_the_same_modules_send_the_same(self):
        self.record()
        out = self.shell("hc replay kept" + OPTIONS)
        self.assertEqual(
            re.sub("[0-9]+ messages", "N messages", out).splitlines(),
            [
                "source: not run: a sensor: the recording stands for it",
                "first.out: N messages, the same",
                "second.out: N messages, the same",
                "last: not run: none of its outputs was recorded",
            ],
        )

    def test_a_module_that_sends_something_else_is_named(self):
        self.record()
        changed = OPTIONS + " --set second.factor=1.5"
        out = self.shell("hc replay kept" + changed, 1)
        self.assertIn("first.out: ", out)
        self.assertRegex(
            out,
            r"\nDIFFERS second.out: (\d) messages, \1 differ; first: seq 0, 0.000 s after the first: "
            r"row 0, column 0, component 0: 1 recorded, 1.5 replayed\n",
        )
        self.assertEqual(
            self.err, "hc replay: Malformed: 1 of 2 outputs differ from the recording\n"
        )
        # What may differ is said for all, for a module or for a port, the most exact counts.
        self.shell("hc replay kept --tolerance 0.5" + changed)
        self.shell("hc replay kept --tolerance 1 --tolerance second.out=0.4" + changed, 1)
        self.shell("hc replay kept --except second" + changed)
        self.shell("hc replay kept --except second.out" + changed)
        self.shell("hc replay kept --share second=0" + changed)
        self.shell("hc replay kept --tolerance nosuch=1" + changed, 2)
        self.assertIn('no module or recorded output "nosuch"', self.err)

    def test_what_is_missing_is_counted(self):
        self.record()
        count = len(self.read("kept/second.out.mtp").splitlines()) // 2
        self.shell("head -n 4 kept/second.out.mtp >short; mv short kept/second.out.mtp")
        out = self.shell("hc replay kept" + OPTIONS, 1)
        self.assertIn("DIFFERS second.out: 2 messages, %d more; first: " % (count - 2), out)

    def test_a_module_is_fed_with_what_it_took(self):
        text = graph("0:1 2:end").replace("rate = 2", "rate = 20")
        latest = 'inputs.in = { from = "source.command", keep = "latest" }'
        self.record(text.replace('inputs.in = "source.command"', latest))
        self.assertIn("first.out: ", self.shell("hc replay kept" + OPTIONS))
        # Without the trace it gets what had been dropped, too.
        self.shell("rm kept/first.trace.mtp")
        out = self.shell("hc replay kept" + OPTIONS, 1)
        self.assertRegex(out, "DIFFERS first.out: [0-9]+ messages, [0-9]+ more; first: ")
        self.assertRegex(out, "\nsecond.out: [0-9]+ messages, the same\n")

    def test_a_task_of_the_head(self):
        graph = str(ROOT / "graphs/score_track.toml") + " --set track_score.duration=2"
        self.shell("hc run --record kept --quiet " + graph)
        first = read_messages(self.path("kept/head_eyes.left.mtp"))[0]
        out = self.shell(
            "hc replay kept --check --graph %s --set head_eyes.start=%d --except head_neck"
            " --share head_eyes=0.7 --time-tolerance workspace=0.25 --share workspace=0.8"
            " --time-tolerance track=0.1 --tolerance track=0.0175 --share track=0.7"
            % (graph, first.time)
        )
        for output in ("left_ball.target", "right_ball.target"):
            self.assertRegex("\n" + out, "\n%s: [0-9]+ messages, the same\n" % output)
        for output in ("head_eyes.left", "workspace.focus", "track.command", "track.bid"):
            self.assertIn("\n%s: " % output, "\n" + out)

    def test_what_is_read_is_the_same(self):
        settings = ["head_eyes.rate=10", "read.repeat=6", "speak.rate=450", "speaker.save=said.wav"]
        settings += ["read_score.count=2", "read_score.pause=0.1"]
        graph = str(ROOT / "graphs/score_read.toml") + "".join(" --set " + s for s in settings)
        self.shell("hc run --record kept --quiet " + graph)
        excepted = "head_neck head_eyes workspace look read_score".split()
        out = self.shell(
            "hc replay kept --check --graph " + graph + "".join(" --except " + e for e in excepted)
        )
        for output in ("read.target", "read.text", "speak.sound"):
            self.assertRegex(out, "\n%s: [0-9]+ messages, the same\n" % output)

    def test_what_cannot_be_replayed_is_said(self):
        self.record()
        self.shell("hc replay nosuch" + OPTIONS, 1)
        self.assertIn("nosuch is not a folder that hc run --record wrote", self.err)
        self.shell("rm kept/source.command.mtp")
        self.assertIn(
            "first: not run: source.command is not in the recording",
            self.shell("hc replay kept" + OPTIONS),
        )
        self.shell("hc replay kept --except second" + OPTIONS, 1)
        self.assertIn("nothing to compare", self.err)
        self.shell("hc replay kept --out again --graph g.toml")
        self.assertEqual(self.read("again/second.out.mtp"), self.read("kept/second.out.mtp"))


if __name__ == "__main__":
    unittest.main()
