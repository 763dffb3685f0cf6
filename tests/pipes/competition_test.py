#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The demonstration graphs of routers, gateway and workspace, with what their modules recorded."""

import os
import re
import signal
import socket
import unittest

from graphs import STOPPABLE, Graphs
from harness import ROOT, WATCHDOG, free_port, wait_until


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
        return super().recorded(output + ".mtp")

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
        top = lambda: self.shell("hc top --once --of %s 2>&1 || true" % name)
        self.wait_for(lambda: ", focus " + focus in top(), "errors")
        self.wait_for(lambda: "bids: left_judge: look 0.90 *, " in top(), "errors")
        self.wait_for(lambda: focus in self.shell("hc ps"), "errors")

        def modes():
            focus = self.state_of(process, name)["focus"]
            return [(focus[which + "_judge"] or {}).get("mode") for which in ("left", "right")]

        self.wait_for(lambda: modes() == ["look", "rest"], "errors")
        self.interrupt(process)


class Stopped(Graphs):
    """What the robot was stopped by, outside the workspace; its rules are in modules/workspace."""

    LOOK = {"mode": "look", "number": 1}

    def test_a_stop_is_shown_and_outlives_the_workspace(self):
        name = "stopped_%d" % os.getpid()
        self.write_graph(STOPPABLE)
        process = self.start("exec hc run g.toml --as %s 2>errors" % name)
        wait_until(lambda: "workspace: focus: look" in self.read("errors"))
        messages = self.observe(process, name)
        wait_focus = lambda focus: self.state(
            messages, lambda state: state["focus"]["workspace"] == focus
        )

        def say(word):
            with socket.socket(socket.AF_UNIX) as link:
                wait_until(lambda: link.connect_ex(self.path("stop")) == 0)
                link.sendall(b"1 12 0 0 8 0 120100 0 0 1 1\n%d\n" % word)

        workspace = self.module(wait_focus(self.LOOK), "workspace")["pid"]
        say(1)
        self.assertEqual(wait_focus(None)["stopped_by"], {"workspace": ["source 12"]})
        self.assertIn(", stopped by source 12", self.shell("hc ps"))
        self.assertIn(", stopped", self.shell("hc top --once --of " + name))
        os.kill(workspace, signal.SIGKILL)
        wait_until(lambda: "stopped by source 12, before the restart" in self.read("errors"))
        state = self.state(
            messages, lambda state: self.module(state, "workspace")["pid"] not in (0, workspace)
        )
        self.assertEqual((state["stopped"], state["focus"]["workspace"]), (["workspace"], None))
        say(2)
        self.assertEqual(wait_focus(self.LOOK)["stopped"], [])
        self.stop(process)


if __name__ == "__main__":
    unittest.main()
