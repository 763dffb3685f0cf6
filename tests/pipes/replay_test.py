#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""hc replay: the modules of a recorded graph run again, and what they send is compared."""

import os
import re
import unittest

from graphs import Graphs
from harness import BUILD, DATA, ROOT
from recordings import read_messages
from trace_test import GRAPH, graph

OPTIONS = " --graph g.toml --check"

# Its link to `small` changes the images that it sends.
CONVERTED = """
[modules.camera]
parameters = {{ source = "%s/aloeL.jpg", width = 200, height = 150, rate = 50, count = 5, loop = true }}
[modules.small]
program = "brightness"
inputs.image = {{ from = "camera.left", keep = "all", {0} }}
[modules.last]
program = "%s/tests/programs/delay"
inputs.in = "small.mean"
""" % (
    DATA,
    BUILD,
)


class Replay(Graphs):
    def record(self, text=graph("0:1 1:end"), kept="kept"):
        self.write("g.toml", "version = 1\n" + text)
        self.shell("hc run g.toml --quiet --record " + kept)

    def test_the_same_modules_send_the_same(self):
        for kept in ("kept", "kept.mcap"):
            self.record(kept=kept)
            # A file of MCAP says which graph was run.
            options = OPTIONS if kept == "kept" else " --check"
            out = self.shell("hc replay " + kept + options)
            self.assertEqual(
                re.sub("[0-9]+ messages", "N messages", out).splitlines(),
                [
                    "source: not run: a sensor: its outputs come from the recording",
                    "first.out: N messages, the same",
                    "second.out: N messages, the same",
                    "last.out: N messages, the same",
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
            self.err,
            "hc replay: 1 of 3 outputs differ from the recording; leave out what depends on a device "
            "or on real time: --except second.out\n",
        )
        # What may differ is said for all, for a module or for a port, the most exact counts.
        self.shell("hc replay kept --tolerance 0.5" + changed)
        self.shell("hc replay kept --tolerance 1 --tolerance second.out=0.4" + changed, 1)
        self.shell("hc replay kept --except second" + changed)
        self.shell("hc replay kept --except second.out" + changed)
        self.shell("hc replay kept --share second=0" + changed)
        self.shell("hc replay kept --tolerance nosuch=1" + changed, 2)
        self.assertIn('no module or recorded output "nosuch"', self.err)

    def test_a_difference_from_one_file_is_named(self):
        text = graph("0:1 2:end").replace("rate = 2", "rate = 20")
        latest = 'inputs.in = { from = "source.command", keep = "latest" }'
        self.record(text.replace('inputs.in = "source.command"', latest), "kept.mcap")
        # Messages that `first` did not handle, as it was too slow, are in the recording.
        self.shell("hc replay kept.mcap" + OPTIONS)
        out = self.shell("hc replay kept.mcap --set second.factor=1.5" + OPTIONS, 1)
        self.assertRegex(
            out, r"\nfirst.out: (\d+) messages, the same\nDIFFERS second.out: \1 messages"
        )

    def test_what_is_missing_is_counted(self):
        self.record()
        count = len(self.read("kept/second.out.mtp").splitlines()) // 2
        self.shell("head -n 2 kept/second.out.mtp >short; mv short kept/second.out.mtp")
        out = self.shell("hc replay kept" + OPTIONS, 1)
        self.assertIn("DIFFERS second.out: 1 messages, %d more; first: " % (count - 1), out)

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

    def test_what_was_dropped_as_bad_is_dropped_again(self):
        text = graph("0:1 1:0.2 2:end").replace("seconds = 0.2", "most = 0.5")
        self.record(text)
        given, handled = (
            len(read_messages(self.path("kept/%s.mtp" % name)))
            for name in ("source.command", "first.out")
        )
        self.assertGreater(given, handled)
        self.assertRegex(self.shell("hc replay kept" + OPTIONS), "first.out: [1-9].*, the same")

    def test_a_link_changes_what_it_sends_again(self):
        for change in ('as = "jpeg", quality = 5', "scale = 0.1", 'as = "jpeg", scale = 0.3'):
            with self.subTest(change=change):
                self.shell("rm -f kept.mcap")
                self.record(CONVERTED.format(change), "kept.mcap")
                out = self.shell("hc replay kept.mcap" + OPTIONS)
                self.assertIn("\nsmall.mean: 5 messages, the same", out)
                self.write("g.toml", "version = 1\n" + CONVERTED.format("rate = 100"))
                out = self.shell("hc replay kept.mcap" + OPTIONS, 1)
                self.assertIn("\nDIFFERS small.mean: 5 messages, 5 differ", out)

    def set_while_recorded(self, setting, text=graph()):
        text = text.replace("rate = 2", "rate = 20").replace("seconds = 0.2", "seconds = 0.001")
        process = self.running_graph(text, "--record kept", "last: started")
        messages = self.observe(process)

        def sent(state):
            return next(link["messages"] for link in state["links"] if link["to"] == "last.in")

        before = sent(self.state(messages, sent))
        self.assertEqual(self.ask(process, setting), ["ok"])
        self.state(messages, lambda state: sent(state) > before + 20)
        self.stop(process)

    def test_a_parameter_that_was_set_is_set_again(self):
        self.set_while_recorded("set second.factor=3")
        self.assertIn("\n3\n", self.read("kept/second.out.mtp"))
        out = self.shell("hc replay kept" + OPTIONS)
        self.assertRegex(out, "\nsecond.out: [0-9]+ messages, the same")

    def test_what_was_set_and_cannot_be_set_again_is_not_judged(self):
        in_their_time = '[modules.second]\nclock = "messages"\n'
        self.set_while_recorded(
            "set second.factor=3", graph(text=GRAPH.replace("[modules.second]\n", in_their_time))
        )
        out = self.shell("hc replay kept" + OPTIONS)
        self.assertIn(
            "\nsecond: not run: its parameter factor was set while it was recorded, and its clock is "
            "that of the messages\n",
            out,
        )

    def test_what_was_restarted_is_not_judged(self):
        self.set_while_recorded("restart second")
        out = self.shell("hc replay kept" + OPTIONS)
        self.assertIn("\nsecond: not run: it was restarted while it was recorded\n", out)

    def test_what_was_linked_to_something_else_is_not_judged(self):
        self.set_while_recorded("link source.command second.in rate=20")
        out = self.shell("hc replay kept" + OPTIONS)
        self.assertIn(
            "\nsecond: not run: it was linked to something else while it was recorded, at in\n", out
        )

    def change_link(self, process, change, port):
        """Changes a link, after some messages of it and before others; ends the graph."""
        some, more = 5, 40  # the counts of a state are up to a second old

        def sent(state):
            return sum(link["messages"] for link in state["links"] if link["to"] == port)

        messages = self.observe(process)
        self.state(messages, lambda state: sent(state) >= some)
        self.assertEqual(self.ask(process, *change), ["ok"])
        least = sent(self.state(messages))

        def has_sent_more(state):
            nonlocal least
            least = min(least, sent(state))  # the count of a new link begins at 0
            return sent(state) >= least + more

        self.state(messages, has_sent_more)
        self.stop(process)

    def test_a_link_that_was_changed_is_changed_again(self):
        text = CONVERTED.format('as = "jpeg", quality = 90').replace("count = 5", "count = 0")
        for change in ("as=jpeg quality=5", "scale=0.1", "rate=20"):
            with self.subTest(change=change):
                self.shell("rm -rf kept")
                process = self.running_graph(text, "--record kept", "last: started")
                self.change_link(
                    process,
                    ["link camera.left small.image keep=all " + change],
                    "small.image",
                )
                trace = self.read("kept/camera.trace.mtp")
                self.assertRegex(trace, "unlinked left [0-9]+ [0-9]+ .*quality=90")
                out = self.shell("hc replay kept" + OPTIONS)
                self.assertRegex(out, "\nsmall.mean: [0-9]+ messages, the same")
                self.assertNotIn("after the last whole step; ", out)

    def test_what_came_from_elsewhere_ends_the_comparison(self):
        text = graph().replace("rate = 2", "rate = 20").replace("seconds = 0.2", "seconds = 0.001")
        process = self.running_graph(text, "--record kept", "last: started")
        self.change_link(
            process,
            ["unlink first.out second.in", "link source.command second.in rate=20"],
            "last.in",
        )
        out = self.shell("hc replay kept" + OPTIONS)
        self.assertRegex(
            out,
            r"\nsecond: replayed up to [0-9.]+ s: a message that it took then at in is not in the "
            r"recording of first.out\nsecond.out: [0-9]+ messages, the same, [0-9]+ after the last whole step\n",
        )

    def test_hosts_need_not_be_there(self):
        self.record()
        away = '[hosts.robot]\nssh = "nosuch.invalid"\n'
        text = self.read("g.toml").replace("[modules.source]", away + "[modules.source]")
        for name in ("first", "last"):
            text = text.replace("[modules.%s]\n" % name, '[modules.%s]\nhost = "robot"\n' % name)
        self.write("g.toml", text)
        out = self.shell("hc replay kept" + OPTIONS)
        self.assertRegex(out, "\nfirst.out: [0-9]+ messages, the same")
        self.assertIn("second  (delay)\n  out → last.in\n", self.shell("hc graph g.toml"))
        self.assertIn("first.out", self.shell("hc ports g.toml"))
        out = self.shell("hc trace last.in --recording kept --graph g.toml")
        self.assertIn("first", out)
        # What a host has of its own is asked there, and the check is about the hosts.
        self.shell("hc check g.toml", 2)
        self.assertIn("host robot: ", self.err)
        self.write("g.toml", text.replace("/delay", "/nosuch"))
        self.shell("hc graph g.toml", 2)
        self.assertIn("host robot: ", self.err)

    def replay_task(self, task, settings, outputs, options="", kept="kept", ends=True):
        """Records a task of the head, until it ends or has sent enough, and replays it, without its
        device."""
        graph = str(ROOT / "graphs" / ("score_%s.toml" % task))
        graph += "".join(" --set " + setting for setting in settings)
        run = "exec hc run --record %s --quiet %s" % (kept, graph)
        if ends:
            self.shell(run)
        else:  # its score takes a fixed time, in which a busy computer may send nothing
            name = "replay_%s_%d" % (task, os.getpid())
            process = self.start(run + " --as " + name)
            self.addCleanup(self.end_well, process)
            self.state(self.observed(process, name), lambda state: self.has_sent(state, outputs))
            self.stop(process)
        options += " --except head_neck"
        out = self.shell("hc replay %s --check --graph %s %s" % (kept, graph, options))
        for output in outputs:
            same = "\n%s: [0-9]+ messages, the same(, [0-9]+ after the last whole step)?\n"
            self.assertRegex("\n" + out, same % output)
        return out

    @staticmethod
    def has_sent(state, outputs):
        few = 5
        enough = {link["from"] for link in state["links"] if link["messages"] >= few}
        return enough.issuperset(outputs)

    def test_track(self):
        self.replay_task(
            "track",
            ["track_score.duration=1e6", "head_eyes.rate=10"],
            "workspace.focus left_ball.target right_ball.target track.bid track.command".split(),
            kept="kept.mcap",
            ends=False,
        )

    def test_read(self):
        settings = ["head_eyes.rate=10", "read.repeat=6", "speak.rate=450", "speaker.save=said.wav"]
        outputs = "workspace.focus read.target read.text look.bid look.command speak.sound"
        self.replay_task(
            "read",
            settings + ["read_score.count=2", "read_score.pause=0.1"],
            outputs.split() + ["read_score.writing"],
        )

    def test_calibrate(self):
        # How many commands it sends, and how often its result, depends on how long it computes.
        out = self.replay_task(
            "calibrate",
            ["head_eyes.rate=5"],
            ["workspace.focus"],
            options="--share calibrate=0.9 --share calibrate.result=0.5",
        )
        self.assertRegex(out, "\ncalibrate.result: [0-9]+ messages, ")
        self.assertRegex(out, "\ncalibrate.command: [0-9]+ messages, ")

    def test_point(self):
        self.replay_task(
            "point",
            ["point_score.count=4"],
            ["workspace.focus", "point.bid", "point.command", "point_score.stick"],
        )

    def test_telepresence(self):
        self.replay_task(
            "telepresence",
            ["follow_score.settle=1", "follow_score.duration=2"],
            ["workspace.focus", "telepresence.bid", "telepresence.command", "follow_score.score"],
            " --except fake_head_tracker",  # whose packets go to a port of the recorded graph
        )

    def test_the_eyes_continue_when_the_neck_falls_silent(self):
        def write(name, header, elements, until):
            with open(self.path(name), "w") as file:
                for time in range(10**9, 10**9 + until, 10**7):
                    file.write("1 1 0 0 8 %d %s 1\n%s\n" % (time, header, elements))

        write("gaze.mtp", "20390 0 13 1", "0 0 0.1", 2 * 10**8)
        write("text.mtp", "60100 0 30 5", "HELLO", 10**9)
        self.shell(
            "hc simulator --clock messages --width 16 --height 16 --rate 20 --in gaze=gaze.mtp"
            " --in text=text.mtp --out left_pose=pose.mtp --out left=left.mtp"
        )
        times = [(each.time - 10**9) // 10**6 for each in read_messages(self.path("pose.mtp"))]
        # 0.1 s behind the last gaze, at 190, it waits for no other.
        self.assertEqual(times, [0, 50, 100, 150] + list(range(250, 1000, 50)))

    def test_what_cannot_be_replayed_is_said(self):
        self.record()
        self.shell("hc replay nosuch" + OPTIONS, 1)
        self.assertIn("nosuch: No such file or directory", self.err)
        self.shell("hc replay nosuch.mcap" + OPTIONS, 1)
        self.assertIn("open(nosuch.mcap): No such file or directory", self.err)
        self.shell("hc replay kept --check", 2)
        self.assertIn("give --graph FILE: kept does not name its graph file", self.err)
        self.shell("rm kept/source.command.mtp")
        self.assertIn(
            "first: not run: source.command is not in the recording",
            self.shell("hc replay kept" + OPTIONS),
        )
        self.shell("hc replay kept --except second --except last" + OPTIONS, 1)
        self.assertIn("nothing to compare", self.err)
        out = self.shell("hc replay kept --out again --graph g.toml")
        count = len(read_messages(self.path("kept/second.out.mtp")))
        self.assertIn(
            "\nsecond.in: %d messages taken\nsecond.out: %d messages sent\n" % (count, count), out
        )
        for wrong in ("--timeout nan", "--tolerance inf"):
            self.shell("hc replay kept --graph g.toml " + wrong, 2)
        self.shell("hc replay tcp:robot:7000" + OPTIONS, 2)
        self.assertIn("tcp:robot:7000 is a link; a recording is a folder or FILE.mcap", self.err)
        self.assertEqual(self.read("again/second.out.mtp"), self.read("kept/second.out.mtp"))
        # A module may be killed before it has begun.
        self.shell(": >kept/second.out.mtp; : >kept/second.trace.mtp")
        self.assertIn(
            "second: not run: it sent nothing while it was recorded",
            self.shell("hc replay kept --except last" + OPTIONS, 1),
        )


if __name__ == "__main__":
    unittest.main()
