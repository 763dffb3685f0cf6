#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The demonstration graphs of routers, gateway and workspace, with what their modules recorded."""

import collections
import json
import os
import pathlib
import re
import signal
import socket
import time
import unittest

from graphs import Graphs
from harness import ROOT, WATCHDOG, free_port, wait_until

Message = collections.namedtuple(
    "Message", "src dst seq ttl time info mode coord width height rows"
)


def read_messages(path):
    """The messages of a recording in text, but for one that is not whole yet."""
    if not os.path.exists(path):
        return []
    lines = pathlib.Path(path).read_text().split("\n")[:-1]
    messages = []
    while lines:
        header = [int(word) for word in lines.pop(0).split()]
        height = header[10]
        if len(lines) < height:
            break
        rows = [[float(number) for number in line.split()] for line in lines[:height]]
        messages.append(Message(*header[1:], rows))
        lines = lines[height:]
    return messages


class Demonstrations(Graphs):
    def write_copy(self, name, *links, **changes):
        """A copy of a demonstration that records outputs, as `"herald.command"`, into files."""
        text = (ROOT / "tests/graphs" / name).read_text()
        for old, new in changes.items():
            self.assertIn(old.strip("_"), text)
            text = text.replace(old.strip("_"), str(new))
        for output in links:
            module, port = output.split(".")
            begin = r"(\[modules\.%s\].*\n)" % module
            route = ', route = "all"' if port == "out" and module.startswith("router") else ""
            link = r'\1outputs.%s = { to = "file:%s.mtp"%s }\n' % (port, output, route)
            text = re.sub(begin, link, text)
        self.write(name, text)

    def recorded(self, output):
        return read_messages(self.path(output + ".mtp"))

    def interrupt(self, process):
        os.kill(process.pid, signal.SIGINT)
        out, _ = process.communicate(timeout=WATCHDOG)
        self.assertEqual(process.returncode, 0)
        return out.decode()

    def wait_for(self, condition, errors):
        """Waits for an event, and shows what the graph said if it does not come."""
        try:
            wait_until(condition)
        except AssertionError:
            self.fail(self.read(errors)[-3000:])

    def test_a_ring_of_routers_delivers_once_and_ends_messages_by_ttl(self):
        sources, letters = ("herald", "whisperer", "caller"), "abc"
        self.write_copy(
            "ring.toml",
            *(source + ".command" for source in sources),
            *("sink_%s.out" % letter for letter in letters),
            *("router_%s.counts" % letter for letter in letters),
        )
        process = self.start("exec hc run ring.toml 2>errors")
        ended = lambda: all(source + ": ended" in self.read("errors") for source in sources)
        self.wait_for(ended, "errors")
        sent = {source: self.recorded(source + ".command") for source in sources}
        self.assertTrue(all(sent.values()))

        def counted(column):
            counts = [self.recorded("router_%s.counts" % letter)[-1:] for letter in letters]
            return sum(count[0].rows[0][column] for count in counts if count)

        def received(letter, source):
            wanted = {"herald": 11, "whisperer": 12, "caller": 13}[source]
            return [each for each in self.recorded("sink_%s.out" % letter) if each.src == wanted]

        # Both ways round meet twice, and both neighbours of the first router end the short-lived.
        kTtl, kSeen = 1, 2
        everything = lambda: (
            counted(kTtl) >= 2 * len(sent["whisperer"])
            and counted(kSeen) >= 2 * len(sent["herald"])
            and len(received("c", "caller")) >= len(sent["caller"])
        )
        self.wait_for(everything, "errors")
        self.interrupt(process)
        self.assertEqual(counted(kTtl), 2 * len(sent["whisperer"]))
        self.assertEqual(counted(kSeen), 2 * len(sent["herald"]))
        numbers = lambda messages: [each.seq for each in messages]
        for letter in letters:
            # In order and once, whichever way each has come.
            self.assertEqual(sorted(numbers(received(letter, "herald"))), numbers(sent["herald"]))
            self.assertEqual(
                numbers(received(letter, "whisperer")),
                numbers(sent["whisperer"]) if letter == "a" else [],
            )
            self.assertEqual(
                numbers(received(letter, "caller")),
                numbers(sent["caller"]) if letter == "c" else [],
            )
        self.assertEqual({each.ttl for each in received("a", "whisperer")}, {1})
        self.assertEqual({each.ttl for each in received("c", "caller")}, {6})
        self.assertEqual({each.dst for each in received("c", "caller")}, {23})
        self.assertRegex(self.read("errors"), r"router_b: \d+ passed; dropped: \d+ ttl, \d+ seen")

    def test_a_gateway_joins_two_graphs(self):
        port = free_port()
        self.write_copy("gateway_b.toml", "sink.out", "brightness.mean", "router.out", _7000_=port)
        self.write_copy("gateway_a.toml", "caller.command", "spy.command", _7000_=port)
        other = self.start("exec hc run gateway_b.toml 2>errors_b")
        self.shell("hc run gateway_a.toml 2>errors_a")
        sent = self.recorded("caller.command")
        self.assertTrue(sent)
        arrived = lambda: (
            len(self.recorded("sink.out")) >= len(sent)
            and len(self.recorded("brightness.mean")) >= 3
        )
        self.wait_for(arrived, "errors_b")
        self.interrupt(other)
        received = self.recorded("sink.out")
        self.assertEqual([each.seq for each in received], [each.seq for each in sent])
        # Two routers and the gateway took one off each.
        self.assertEqual({each[:2] + (each.ttl,) for each in received}, {(111, 112, 5)})
        self.assertEqual(len(self.recorded("brightness.mean")), 3)
        self.assertRegex(
            self.read("errors_a"),
            r"gateway: %d passed; dropped: 0 ttl, %d not listed, 0 without a route"
            % (len(sent) + 3, len(self.recorded("spy.command"))),
        )
        got = self.shell("hc info router.out.mtp")
        self.assertRegex(got, "rgb_image.*jpeg")
        self.assertNotIn("116 binary", got)

    def test_in_a_contest_the_actor_takes_commands_of_the_mode_in_focus_alone(self):
        self.write_copy("contest.toml", "actor.done", "workspace.focus", "looking.command")
        self.shell("hc run contest.toml 2>errors")
        done = [each.rows[0] for each in self.recorded("actor.done")]
        self.assertEqual([mode for mode, _ in done], [focus for _, focus in done])
        changes = []
        for each in self.recorded("workspace.focus"):
            if not changes or changes[-1][1] != each.rows[0][0]:
                changes.append((each.time, each.rows[0][0]))
        self.assertEqual([mode for _, mode in changes if mode != 0][:4], [1, 2, 3, 2])
        self.assertEqual({mode for mode, _ in done}, {1, 2, 3})
        self.assertLess([mode for mode, _ in done].count(1), len(self.recorded("looking.command")))
        # What was taken by bidding more was held for the dwell time; the clock of the recording is
        # read a little behind the decision.
        at = {mode: time for time, mode in reversed(changes)}
        self.assertGreater(min(at[2] - at[1], at[3] - at[2]), 0.8e9)

    def test_a_person_takes_the_focus_whatever_the_dwell_time_says(self):
        self.write_copy("contest.toml", "actor.done", "workspace.focus")
        person = '[modules.workspace]\ninputs.person = "unix-listen:person"\n'
        self.write(
            "contest.toml", self.read("contest.toml").replace("[modules.workspace]\n", person)
        )
        process = self.start(
            "exec hc run contest.toml --set workspace.dwell=3600 --set workspace.person_expiry=3600 "
            "--set looking.script=0:0.9 --set tracking.script=0:0 --set reading.script=0:0 2>errors"
        )
        latest = lambda: [each.rows[0][0] for each in self.recorded("workspace.focus")[-1:]]
        self.wait_for(lambda: latest() == [1], "errors")
        with socket.socket(socket.AF_UNIX) as person:
            person.connect(self.path("person"))
            say = lambda salience: person.sendall(b"1 0 0 0 8 0 120190 3 0 1 1\n%s\n" % salience)
            for salience in (b"nan", b"-1", b"2"):
                say(salience)  # refused, and nothing ends
            say(b"0.01")
            self.wait_for(lambda: latest() == [3], "errors")
            count = len(self.recorded("actor.done"))
            say(b"0")
            self.wait_for(lambda: latest() == [1], "errors")
        self.wait_for(lambda: len(self.recorded("actor.done")) > count + 1, "errors")
        self.interrupt(process)
        self.assertEqual({tuple(each.rows[0]) for each in self.recorded("actor.done")}, {(1, 1)})
        self.assertIn("workspace: bid refused: Malformed: salience nan", self.read("errors"))
        self.assertIn("bids refused: 3 for their salience", self.read("errors"))

    def test_the_focus_is_shown_though_no_module_hears_it(self):
        self.write(
            "g.toml",
            """version = 1
[modes]
look = 1
[workspace]
module = "workspace"
[modules.workspace]
inputs.bids = "looking.bid"
[modules.looking]
program = "bidder"
mode = "look"
""",
        )
        name = "unheard_%d" % os.getpid()
        process = self.start("exec hc run g.toml --as %s 2>errors" % name)
        top = lambda: self.shell("hc top %s 2>&1 || true" % name)
        self.wait_for(lambda: ", focus look" in top(), "errors")
        self.interrupt(process)

    def test_each_of_two_robots_in_a_graph_shows_its_own_focus(self):
        self.write(
            "robot.toml",
            """version = 1
[modes]
look = 1
rest = 2
[workspace]
module = "judge"
[modules.judge]
program = "workspace"
inputs.bids = ["looking.bid", "resting.bid"]
[modules.looking]
program = "bidder"
mode = "look"
parameters.script = "0:0.9"
[modules.resting]
program = "bidder"
mode = "rest"
parameters.script = "0:0.5"
""",
        )
        self.write(
            "two.toml",
            """version = 1
[graphs.left]
file = "robot.toml"
[graphs.right]
file = "robot.toml"
[graphs.right.modules.looking]
parameters.script = "0:0.1"
""",
        )
        name = "two_%d" % os.getpid()
        process = self.start("exec hc run two.toml --as %s 2>errors" % name)
        focus = "left_judge: look, right_judge: rest"
        top = lambda: self.shell("hc top --once %s 2>&1 || true" % name)
        self.wait_for(lambda: ", focus " + focus in top(), "errors")
        self.wait_for(lambda: "bids: left_judge: look 0.90 *, " in top(), "errors")
        self.wait_for(lambda: focus in self.shell("hc ps"), "errors")

        def modes():
            focus = json.loads(self.shell("hc top --once --json %s" % name))["focus"]
            return [(focus[which + "_judge"] or {}).get("mode") for which in ("left", "right")]

        self.wait_for(lambda: modes() == ["look", "rest"], "errors")
        self.interrupt(process)

    def test_nobody_commands_the_actor_while_the_workspace_hangs_or_is_dead(self):
        self.write_copy("contest.toml", "actor.done", "looking.command", never="failure")
        process = self.start(
            "exec hc run contest.toml --set looking.script=0:0.9 --set tracking.script=0:0 "
            "--set reading.script=0:0 2>errors"
        )
        done = lambda: len(self.recorded("actor.done"))
        sent = lambda: len(self.recorded("looking.command"))
        self.wait_for(lambda: done() > 3, "errors")
        messages = self.observe(process, "contest")
        focused = lambda state: any(state["focus"].values())
        state = self.state(messages, focused)
        workspace = self.module(state, "workspace")["pid"]
        os.kill(workspace, signal.SIGSTOP)
        self.state(messages, lambda state: not focused(state))
        before, so_far = done(), sent()
        self.wait_for(lambda: sent() > so_far + 20, "errors")
        self.assertEqual(done(), before)
        os.kill(workspace, signal.SIGCONT)
        self.state(messages, focused)
        self.wait_for(lambda: done() > before, "errors")
        os.kill(workspace, signal.SIGKILL)
        again = lambda state: self.module(state, "workspace")["pid"] not in (0, workspace)
        self.state(messages, lambda state: again(state) and focused(state))
        before = done()
        self.wait_for(lambda: done() > before, "errors")
        self.interrupt(process)
        self.assertIn("workspace: focus: ", self.read("errors"))


class Sources(Graphs):
    """Who may give the focus away, and who stops the robot: each source by itself."""

    GRAPH = """
[modes]
look = 1
[workspace]
module = "workspace"
[modules.workspace]
inputs.bids = "looking.bid"
[[modules.workspace.inputs.stop]]
from = "unix-listen:stop"
[[modules.workspace.inputs.person]]
from = "unix-listen:person"
[modules.looking]
program = "bidder"
mode = "look"
"""
    LOOK = {"mode": "look", "number": 1}

    def start_workspace(self):
        self.name = "sources_%d" % os.getpid()
        self.write_graph(self.GRAPH)
        self.process = self.start("exec hc run g.toml --as %s 2>errors" % self.name)
        self.messages = self.observe_soon()
        self.wait_focus(self.LOOK)

    def observe_soon(self):
        found = []

        def observes():
            try:
                found.append(self.observe(self.process, self.name))
            except OSError:
                return False
            return True

        wait_until(observes)
        return found[0]

    def wait_focus(self, focus):
        return self.state(self.messages, lambda state: state["focus"]["workspace"] == focus)

    def connect(self, name):
        link = socket.socket(socket.AF_UNIX)
        self.addCleanup(link.close)
        wait_until(lambda: link.connect_ex(self.path(name)) == 0)
        return link

    @staticmethod
    def say(link, source, word):
        link.sendall(b"1 %d 0 0 8 0 120100 0 0 1 1\n%d\n" % (source, word))

    def wait_said(self, text, count=1):
        wait_until(lambda: self.read("errors").count(text) >= count)

    def kill(self, module):
        before = self.module(self.state(self.messages), module)["pid"]
        os.kill(before, signal.SIGKILL)
        again = lambda state: (
            self.module(state, module)["pid"] not in (0, before)
            and self.module(state, module)["status"] == "running"
        )
        return self.state(self.messages, again)

    def test_a_source_does_not_withdraw_the_bid_of_another(self):
        for port in ("person", "bids"):
            focus = "focus." + port
            process = self.start(
                "exec hc workspace --in %s=unix-listen:%s.in --out focus=file:%s --expiry 60 "
                "--mode_names point=2" % (port, port, focus)
            )
            link = self.connect(port + ".in")
            row = b"1 %d 0 0 8 0 120190 2 0 1 1\n%d\n"
            link.sendall(row % (1, 1))
            rows = lambda: [each.rows[0][0] for each in read_messages(self.path(focus))]
            wait_until(lambda: 2 in rows())
            link.sendall(row % (2, 0))
            count = len(rows())
            wait_until(lambda: len(rows()) > count + 20)
            self.assertEqual(set(rows()[rows().index(2) :]), {2})
            link.sendall(row % (1, 0))
            wait_until(lambda: rows()[-1] == 0)
            process.kill()

    def test_a_bid_for_no_mode_of_the_graph_or_of_another_time_is_refused(self):
        self.start_workspace()
        link = self.connect("person")
        now = time.time_ns()
        for mode, stamp in ((9, 0), (1, 1), (1, now - 3600 * 10**9), (1, now + 3600 * 10**9)):
            link.sendall(b"1 5 0 0 8 %d 120190 %d 0 1 1\n1\n" % (stamp, mode))
        self.wait_said("bid refused: Malformed: the graph has no mode 9")
        self.stop(self.process)
        self.assertIn("1 for their mode, 3 for their time", self.read("errors"))
        self.assertNotIn("a person", self.read("errors"))

    def test_each_stop_holds_until_its_own_source_or_a_person_clears_it(self):
        self.start_workspace()
        link = self.connect("stop")
        self.say(link, 7, 1)
        self.assertEqual(self.wait_focus(None)["stopped"], ["workspace"])
        self.assertIn(", stopped", self.shell("hc ps"))
        self.assertIn(", stopped", self.shell("hc top --once " + self.name))
        self.say(link, 12, 1)
        self.say(link, 7, 0)
        self.say(link, 13, 0)
        self.say(link, 14, 9)
        self.wait_said("stop refused: a stop is 0, 1, 2 or 3, not 9")
        self.assertEqual(self.state(self.messages)["stopped"], ["workspace"])
        self.say(link, 12, 0)
        self.assertEqual(self.wait_focus(self.LOOK)["stopped"], [])
        for source in (7, 12):
            self.say(link, source, 1)
        self.wait_focus(None)
        self.say(link, 13, 2)
        self.wait_focus(self.LOOK)
        self.assertIn("stopped by source 7", self.read("errors"))
        self.assertIn("stop cleared by source 13", self.read("errors"))

    def test_a_stop_outlives_the_workspace(self):
        self.start_workspace()
        self.say(self.connect("stop"), 12, 1)
        self.wait_focus(None)
        for _ in range(3):
            state = self.kill("workspace")
            self.assertEqual(state["stopped"], ["workspace"])
            self.assertEqual(state["focus"]["workspace"], None)
        self.assertEqual(self.ask(self.process, "restart workspace", name=self.name), ["ok"])
        self.wait_said("stopped by source 12, before the restart", 4)
        link = self.connect("stop")
        self.say(link, 12, 0)  # as one that was restarted too
        self.wait_said("the stop of source 12 holds")
        self.assertEqual(self.state(self.messages)["stopped"], ["workspace"])
        self.say(link, 12, 2)
        self.assertEqual(self.wait_focus(self.LOOK)["stopped"], [])
        self.assertEqual(self.kill("workspace")["stopped"], [])
        self.wait_focus(self.LOOK)

    def test_who_guards_and_is_silent_halts_the_robot(self):
        self.start_workspace()
        link = self.connect("stop")
        silent = "focus: none; source 12 is silent: its stop could not arrive"
        for _ in range(2):
            self.say(link, 12, 0)
        self.wait_said(silent)
        self.wait_focus(None)
        self.assertEqual(self.state(self.messages)["stopped"], [])
        self.kill("workspace")  # what guards outlives it too
        self.wait_focus(None)
        link = self.connect("stop")
        focused = self.read("errors").count("focus: look")
        self.say(link, 12, 0)
        self.wait_said("focus: look", focused + 1)
        self.wait_said(silent, 2)
        self.say(link, 12, 0)
        self.say(link, 12, 3)
        self.wait_focus(self.LOOK)


if __name__ == "__main__":
    unittest.main()
