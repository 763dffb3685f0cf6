#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Graphs that run, seen and changed by the verbs of hc: ps, top and graph."""

import json
import os
import pathlib
import pty
import re
import signal
import unittest

from graphs import GRAPH, Graphs
from harness import DATA, ROOT, WATCHDOG, free_port, wait_until


class Watching(Graphs):
    def test_a_graph_is_listed_shown_and_drawn(self):
        name, process = self.run_named("seen")
        wait_until(lambda: re.search(name + " .* 2/2 .* running", self.listed()))

        def running():
            top = self.hc("top --of " + name)
            is_so = re.search(r"camera +[0-9.]+% +[0-9.]+ MB +0 +running", top)
            return (
                is_so
                and re.search(name + ": running .*, 2/2 modules up, .* messages/s", top)
                and top
            )

        top = wait_until(running)
        self.assertRegex(top, "RESTARTS +MODE +STATUS\n")
        self.assertRegex(top, "THROTTLED +DROPPED +IGNORED\n")
        self.assertRegex(top, "camera.left → brightness.image .*[0-9][kM]?B")
        text = self.hc("graph --of %s.%d" % (name, process.pid))
        self.assertRegex(
            text, r"camera  \([0-9.]+ %\)\n  left → brightness.image  [0-9.]+/s, keep latest\n"
        )
        self.assertIn(
            '"camera":"out_left":e -> "brightness":"in_image":w [',
            self.hc("graph --dot --of " + name),
        )
        self.hc("graph --svg g.svg --of " + name)
        image = pathlib.Path(self.path("g.svg")).read_text()
        for word in ("camera", "brightness", "left", "image"):
            self.assertIn(">%s</text>" % word, image)
        self.stop(process)
        self.assertNotIn(name, self.listed())

    def test_a_name_that_is_given_is_refused_when_taken(self):
        name, process = self.run_named("taken")
        self.assertEqual(
            self.hc("run g.toml --as " + name, 2),
            "hc run: Invalid: --as %s: %s.%d is running\n" % (name, name, process.pid),
        )

    def test_a_file_is_drawn_without_running(self):
        self.write_graph(GRAPH + "keep = 3\n")
        self.assertIn("  left → brightness.image  keep 3\n", self.hc("graph g.toml"))
        self.write_graph(GRAPH.replace("camera.left", "b.left"))
        self.assertIn('no module "b"', self.hc("graph g.toml", 2))
        self.assertIn("left → depth.left", self.hc("graph depth"))
        self.write_graph(
            GRAPH.replace("[modules.b", 'mode = "look"\n[modes]\nlook = 1\n[modules.b', 1)
        )
        self.assertIn("camera  (mode: look)", self.hc("graph g.toml"))

    def test_a_running_graph_is_changed(self):
        name, process = self.run_named("changed")
        of = " --of " + name
        self.hc("graph set camera.rate=20" + of)
        self.hc("graph add second brightness" + of)
        self.hc("graph link camera.left second.image keep=latest" + of)
        wait_until(lambda: "left → second.image" in self.hc("graph" + of))
        self.hc("graph unlink camera.left brightness.image" + of)
        self.hc("graph remove brightness" + of)
        wait_until(lambda: "brightness" not in self.hc("graph" + of))
        self.assertEqual(
            self.hc("graph set camera.raet=50" + of, 2),
            'hc graph: Invalid: module camera has no parameter "raet", did you mean "rate"?\n',
        )
        self.assertRegex(
            self.hc("graph get camera.rate" + of),
            r"camera.rate = 20 Hz +\(from 0 to .*default 0\)\n",
        )
        self.assertRegex(
            self.hc("graph get camera" + of),
            r"\ncamera.reopen = true +\(default true, set restarts the module\)\n",
        )
        self.assertIn('no parameter "rat", did you mean', self.hc("graph get camera.rat" + of, 2))
        self.shell("hc graph set camera.reopen=false" + of)
        self.assertIn("restarting camera", self.err)
        wait_until(lambda: re.search(r"camera .* 1 +running", self.hc("top --of " + name)))
        self.hc("graph restart camera second" + of)
        restarts = lambda state, each: self.module(state, each)["restarts"]
        self.state(
            self.observe(process, name),
            lambda state: (restarts(state, "camera"), restarts(state, "second")) == (2, 1),
        )
        self.shell("hc graph set camera.source=nosuch.ppm" + of)
        self.assertIn("restarting camera", self.err)
        wait_until(lambda: "given up" in self.hc("top --of " + name))
        self.shell("hc graph set camera.source=%s/aloeR.jpg" % DATA + of)
        wait_until(lambda: re.search(r"camera .* running", self.hc("top --of " + name)))

    def test_no_word_is_ignored(self):
        name, _ = self.run_named("words")
        of = " --of " + name
        self.hc("graph set camera.rate=30 camera.width=81" + of)
        self.assertEqual(
            re.findall("= ([0-9]+)", self.hc("graph get camera.rate camera.width" + of)),
            ["30", "81"],
        )
        self.assertIn(
            'no parameter "hheight"',
            self.hc("graph set camera.rate=40 camera.hheight=60" + of, 2),
        )
        self.assertIn("camera.rate = 30 ", self.hc("graph get camera.rate" + of))
        self.assertIn('no module "nosuch"', self.hc("graph get camera.rate nosuch" + of, 2))
        self.assertIn('no module "nosuch"', self.hc("graph restart camera nosuch" + of, 2))
        self.assertIn("not expected: more", self.hc("graph stop more" + of, 2))
        self.assertIn("stop excludes graph", self.hc("graph g.toml stop" + of, 2))

    def test_graphs_of_one_name_are_listed_as_of_takes_them(self):
        name, one = self.run_named("twin")
        self.assertRegex(self.listed(), "\n%s +%d " % (name, one.pid))
        self.shell("mv g.toml %s.toml" % name)
        two = self.start("exec hc run %s.toml" % name)
        self.await_lines(two, "brightness: started")
        listed = self.listed()
        for process in (one, two):
            self.assertRegex(listed, r"\n%s\.%d +%d " % (name, process.pid, process.pid))
            self.hc("graph stop --of %s.%d" % (name, process.pid))
            self.assertEqual(process.wait(timeout=WATCHDOG), 0)

    def test_a_running_port_comes_before_a_file(self):
        name, _ = self.run_named("ports")
        self.environment["HC_GRAPH"] = name
        self.shell("hc record camera.left", 2)
        self.assertIn("camera.left is a port of a running graph", self.err)
        self.assertFalse(os.path.exists(self.path("camera.left")))
        self.shell("hc record brightness.mean y.mtp --count 3")
        self.assertEqual(self.shell("hc cat y.mtp").count("table"), 3)
        self.shell("hc send 1 | hc record ./camera.left")
        self.assertIn("table", self.shell("hc cat ./camera.left"))
        self.assertIn("rgb_image", self.shell("hc cat camera.left --count 1"))
        self.assertIn("\n5 messages", self.shell("hc info camera.left --count 5"))
        self.shell("hc view camera.left --save v.png --count 2")
        self.assertTrue(os.path.exists(self.path("v.png")))
        self.shell("hc info z.nothing", 2)
        self.assertIn('z.nothing: no such file, and no port "z.nothing"', self.err)

    def test_a_port_is_observed_by_name_and_nothing_changes(self):
        name, process = self.run_named("observed")
        of, messages = " --of " + name, self.observe(process, name)
        before = self.state(messages)
        self.assertRegex(self.hc("cat camera.left --count 2" + of), "rgb_image 80 x 60")
        self.assertRegex(self.hc("cat brightness.image --count 1" + of), "rgb_image 80 x 60")
        self.assertRegex(self.hc("cat brightness.mean --json --count 3" + of), '"elements"')
        self.hc("record r.mtp --in camera.left --in brightness.mean --count 4" + of)
        self.assertRegex(self.hc("info r.mtp"), "rgb_image 80 x 60")
        after = self.state(messages)
        self.assertEqual(
            [(each["from"], each["to"]) for each in before["links"]],
            [(each["from"], each["to"]) for each in after["links"]],
        )
        self.assertIn(
            'no port "camera.lef", did you mean "camera.left"?', self.hc("cat camera.lef" + of, 2)
        )

    def test_an_observer_that_stops_or_dies_holds_nobody_up(self):
        name, process = self.run_named("held")
        messages = self.observe(process, name)
        observer = self.start("exec hc cat camera.left --raw --of %s >out" % name)
        wait_until(
            lambda: os.path.getsize(self.path("out")) if os.path.exists(self.path("out")) else 0
        )
        os.kill(observer.pid, signal.SIGSTOP)
        sent = lambda state: state["links"][0]["messages"]
        first = sent(self.state(messages))
        self.state(messages, lambda state: sent(state) > first + 20)
        os.kill(observer.pid, signal.SIGKILL)
        first = sent(self.state(messages))
        self.state(messages, lambda state: sent(state) > first + 20)

    def test_a_peer_that_has_left_is_seen(self):
        port = free_port()
        end = "tcp:%d?reconnect=60" % port
        text = GRAPH.partition("[modules.brightness]")[0] + 'outputs.left = "%s"\n' % end
        name, _ = self.run_named("alone", text, "nobody|no peer|retrying|waiting")
        top = lambda: self.hc("top --of " + name)
        wait_until(
            lambda: re.search("camera.left → tcp:%d.* nobody is there|no peer" % port, top())
        )

    def test_what_is_lost_without_a_reader_is_counted(self):
        port = free_port()
        end = "tcp-listen:%d?readers=0" % port
        text = GRAPH.partition("[modules.brightness]")[0] + 'outputs.left = "%s"\n' % end
        name, _ = self.run_named("unread", text, "camera: started")
        lost = r"camera.left → tcp-listen:%d.* [1-9]\d* lost without a reader" % port
        wait_until(lambda: re.search(lost, self.hc("top --of " + name)))

    def test_a_link_that_is_back_is_no_trouble(self):
        port = free_port()
        text = '[modules.brightness]\ninputs.image = "tcp:%d?reconnect=60"\n' % port
        name, process = self.run_named("back", text)
        messages = self.observe(process, name)
        link = lambda condition: self.state(messages, lambda each: condition(each["links"][0]))
        camera = "exec hc camera %s/HappyFish.jpg --loop --rate 50 --width 80 --height 60" % DATA
        publish = camera + " --out tcp-listen:%d" % port
        writer = self.start(publish)
        link(lambda link: link["per_second"] > 0)
        os.kill(writer.pid, signal.SIGKILL)
        link(lambda link: link["status"] == "not connected")
        writer = self.start(publish)
        link(lambda link: link["per_second"] > 0 and not link["status"])
        os.kill(writer.pid, signal.SIGSTOP)  # what the link has said last is shown when it is still
        state = link(lambda link: link["per_second"] == 0)
        self.assertEqual(state["links"][0]["status"], "")
        self.assertRegex(self.hc("top --of " + name), r"brightness .* running \| .*: reconnected")

    def test_an_observer_outlives_restarts_and_ends_with_the_graph(self):
        name, process = self.run_named("restarted")
        observer = self.start("exec hc cat camera.left --json --of %s >out" % name)
        lines = lambda: self.read("out").count("\n")
        wait_until(lines)
        self.hc("graph restart camera --of " + name)
        numbers = lambda: [int(seq) for seq in re.findall(r'"seq":(\d+),', self.read("out"))]
        wait_until(lambda: numbers() != sorted(numbers()))  # the new process begins at 0
        self.stop(process)
        self.assertEqual(observer.wait(timeout=WATCHDOG), 0)

    def test_the_graph_of_this_folder_comes_first(self):
        first, _ = self.run_named("first")
        os.mkdir(self.path("other"))
        second = "second_%d" % os.getpid()
        two = self.start("cd other && exec hc run ../g.toml --as " + second)
        self.await_lines(two, "brightness: started")
        self.assertIn(first + ": running", self.shell("hc top --once"))
        self.assertIn(second + ": running", self.shell("cd other && hc top --once"))
        self.assertIn(second + ": running", self.shell("HC_GRAPH=%s hc top --once" % second))
        self.shell("cd / && hc top --once", 2)
        # Graphs of other tests may run beside these.
        self.assertRegex(self.err, r"several graphs are running; pass --of NAME: .*%s\." % first)
        states = [json.loads(line) for line in self.hc("ps --json").splitlines()]
        modules = {state["graph"]: len(state["modules"]) for state in states}
        self.assertEqual((modules[first], modules[second]), (2, 2))
        self.stop(two)

    def test_who_waits_for_a_reader_is_not_stalled(self):
        end = "unix-listen:@hc_%d" % os.getpid()
        text = GRAPH.partition("[modules.brightness]")[0] + 'outputs.left = "%s"\n' % end
        name, process = self.run_named("waits", text, "camera: started")
        waits = "camera .* has waited [0-9]+ s for %s\n" % end
        wait_until(lambda: re.search(waits, self.hc("top --of " + name)))
        waiting = r"camera  \(has waited [0-9]+ s for %s\)\n" % end
        wait_until(lambda: re.search(waiting, self.hc("graph --of " + name)))
        self.assertRegex(self.listed(), name + " .* 1/1 .* running\n")
        camera = self.module(self.state_of(process, name), "camera")
        os.kill(camera["pid"], signal.SIGSTOP)
        wait_until(lambda: "stalled: stopped by a signal" in self.hc("top --of " + name))
        os.kill(camera["pid"], signal.SIGCONT)
        wait_until(lambda: re.search(waits, self.hc("top --of " + name)))

    def test_help_says_what_each_word_is(self):
        for verb, words in (
            ("add", ["MODULE", "PROGRAM", "SETTING"]),
            ("remove", ["MODULE"]),
            ("restart", ["MODULE"]),
            ("get", [r"MODULE[.PARAMETER]"]),
            ("link", ["FROM", "TO", "POLICY"]),
            ("unlink", ["FROM", "TO"]),
            ("set", ["SETTING"]),
        ):
            text = self.hc("graph %s --help" % verb)
            for word in words:
                self.assertRegex(
                    text, r"\n  %s TEXT( \.{3})?( REQUIRED)?\s+[a-z].* [a-z]" % re.escape(word)
                )

        self.assertIn("MODULE.PARAMETER=VALUE", self.hc("graph set --help"))
        self.assertIn("PARAMETER=VALUE", self.hc("graph add --help"))
        text = self.hc("graph link --help")
        for key in "keep rate burst memory as quality scale".split():
            self.assertRegex(text, r"KEY=VALUE: [^\n]*\b%s\b" % key)

    def test_who_asks_a_graph_is_no_graph(self):
        """Several may ask at once, each listening for its answer, and need not say which graph."""
        name, process = self.run_named("asked")
        os.kill(process.pid, signal.SIGSTOP)
        asking = self.start("exec hc graph set camera.rate=20 --of " + name)
        listening = lambda: [
            line.split()[-1]
            for line in pathlib.Path("/proc/net/unix").read_text().splitlines()
            if "-answer.%d." % asking.pid in line
        ]
        wait_until(listening)
        self.assertRegex(listening()[0], "^@hypercolumn-answer")
        os.kill(process.pid, signal.SIGCONT)
        self.assertEqual(asking.wait(timeout=WATCHDOG), 0)

    def test_what_does_not_run_is_reported(self):
        name, process = self.run_named("here")
        self.assertIn(
            'did you mean "%s"?' % name, self.hc("top --of " + name.replace("here", "hree"), 1)
        )
        self.stop(process)
        self.assertIn("NotFound: no graph", self.hc("graph set a.b=1 --of nowhere", 1))

    def test_top_keeps_the_terminal_as_it_was(self):
        name, _ = self.run_named("live")
        pid, terminal = pty.fork()
        if pid == 0:
            os.environ.update(self.environment)
            os.execvp("hc", ["hc", "top", "--of", name])
        shown = b""
        while shown.count(b"camera.left") < 2:  # two pages
            shown += os.read(terminal, 65536)
        os.write(terminal, b"q")
        try:
            while piece := os.read(terminal, 65536):
                shown += piece
        except OSError:
            pass  # how the end of a terminal is reported
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]), 0)
        self.assertTrue(shown.startswith(b"\x1b[?1049h"))
        self.assertTrue(shown.endswith(b"\x1b[?1049l"))

    def test_the_global_workspace_is_bold(self):
        text = (ROOT / "tests/graphs/contest.toml").read_text()
        text = (
            text.replace("version = 1\n", "").replace("2:0.9 4:0 ", "").replace("5:end", "600:end")
        )  # tracking wins for good
        name, _ = self.run_named("contest", text, "actor: started")

        def is_bold():
            dot = self.hc("graph --dot --of " + name)
            if not re.search('"tracking":.* -> "actor":.*penwidth=3', dot):
                return False
            self.assertNotRegex(dot, '"looking":.* -> "actor":.*penwidth')
            self.assertIn("focus: track", dot)
            return True

        wait_until(is_bold)
        wait_until(lambda: "focus track" in self.hc("top --of " + name))


if __name__ == "__main__":
    unittest.main(verbosity=0)
