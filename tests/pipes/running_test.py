#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Graphs while they run: what hc run says of them, takes, and does when they change."""

import json
import os
import pathlib
import re
import signal
import socket
import time
import unittest

from graphs import GRAPH, Graphs
from harness import BUILD, WATCHDOG, wait_until


def report(row):
    """A line of a shell that is a module: it reports a line of its log (spec/module.md, report 5)."""
    return (
        """python3 - "$@" <<'END'
import socket, sys
place = sys.argv[sys.argv.index("--manage") + 1]
reports = socket.socket(socket.AF_UNIX)
reports.connect("\\0" + place.split("?")[0].partition("@")[2])
row = b"%s"
reports.sendall(b"1 5 0 0 8 0 60101 0 0 %%d 1\\n%%s\\n" %% (len(row), row))
END
"""
        % row
    )


class Running(Graphs):
    def test_two_graphs_run_side_by_side(self):
        self.write_graph(GRAPH)
        first, second = self.run_graph(), self.run_graph("--as other")
        for process, name in ((first, "g"), (second, "other")):
            state = self.state(
                self.observe(process, name), lambda state: state["links"][0]["messages"] > 0
            )
            self.assertEqual((state["graph"], state["pid"]), (name, process.pid))
            self.assertEqual(state["status"], "running")
        out, err = self.stop(first)
        self.assertIn("g.toml ran for ", out)
        self.assertIn("graph: stopping\n", err)
        self.assertNotIn("reconnecting", err)
        self.assertEqual(self.ask(second, "stop", name="other"), ["ok"])
        self.assertEqual(second.wait(timeout=WATCHDOG), 0)

    def test_a_closed_terminal_ends_it_cleanly(self):
        process = self.running_graph()
        process.send_signal(signal.SIGHUP)
        _, err = process.communicate(timeout=WATCHDOG)
        self.assertEqual(process.returncode, 0, err)
        self.assertIn(b"graph: stopping", err)

    def test_a_module_that_is_not_built_is_said_to_be(self):
        self.shell("mkdir -p tree/build/bin tree/modules/unbuilt; touch tree/build/CMakeCache.txt")
        self.shell("cp %s/bin/hc tree/build/bin" % BUILD)
        self.write("g.toml", "version = 1\n[modules.a]\nprogram = 'unbuilt'\n")
        self.shell("tree/build/bin/hc check g.toml", 2)
        why = 'no program "unbuilt": it is not built; ./dev build builds all modules'
        self.assertEqual(self.err, "hc check: error: g.toml:3: %s\n" % why)

    def test_an_edited_file_changes_the_graph(self):
        process = self.running_graph()
        self.write_graph(GRAPH.replace("brightness]", "brihtness]"))
        lines = self.await_lines(process, "graph: keeping the running version")
        self.assertIn('no program "brihtness", did you mean "brightness"?', "\n".join(lines))
        more = "[modules.more]\nprogram = 'brightness'\ninputs.image = 'camera.left'\n"
        self.write_graph(GRAPH + more)
        self.await_lines(process, "more: started")
        self.write_graph(GRAPH)
        self.await_lines(process, "more: ended")
        # One that comes first in the file has a number of its own, and the others keep theirs.
        first = more.partition("inputs")[0]
        self.write_graph(GRAPH.replace("[modules.camera]", first + "[modules.camera]"))
        self.await_lines(process, "graph: changed")
        _, err = self.stop(process)
        self.assertNotIn("brightness: started", err)
        self.assertNotIn("camera: started", err)

    def test_commands_change_the_graph_as_it_was_read_last(self):
        process = self.running_graph()
        observed = self.observe(process)
        self.write_graph("[modules.camera\n")
        self.await_lines(process, "graph: keeping the running version")
        self.assertEqual(self.ask(process, "set camera.rate=20"), ["ok"])
        rate = lambda state: self.module(state, "camera")["parameters"]["rate"]
        self.state(observed, lambda state: rate(state) == "20")
        # An edited file counts alone.
        self.write_graph(GRAPH + "[modules.more]\nprogram = 'brightness'\n")
        self.state(observed, lambda state: self.module(state, "more") and rate(state) == "50")

    def test_programs_beside_the_file_stay_where_they_are(self):
        os.mkdir(self.path("task"))
        self.shell("cp %s/libexec/hypercolumn/brightness task/mine" % BUILD)
        mine = "[modules.mine]\nprogram = './mine'\n"
        self.write("task/g.toml", "version = 1\n" + GRAPH + mine)
        name = "beside_%d" % os.getpid()
        process = self.start("exec hc run task/g.toml --as " + name)
        self.await_lines(process, "mine: started")
        for command in ("restart mine", "link camera.left mine.image", "add second task/mine"):
            self.shell("hc graph %s --of %s" % (command, name))
        self.stop(process)

    FILTER = """#!/bin/bash
[ "$1" = --describe ] && exec echo '{"inputs":[{"name":"in","types":[]}],
  "outputs":[{"name":"out","types":[]}],
  "parameters":[{"name":"factor","type":"number","default":1,"min":0,"max":9}]}'
for word; do case $word in in=*) in=${word#in=};; out=*) out=${word#out=};; esac; done
hc cat --raw "$in" | hc play --speed max --out "$out" /dev/stdin
"""

    def test_a_module_without_control_ends_no_neighbour(self):
        self.write("filter", self.FILTER, 0o755)
        links = "[modules.filter]\nprogram = './filter'\ninputs.in = 'camera.left'\n"
        process = self.running_graph(
            GRAPH.replace("camera.left", "filter.out") + links, last="filter: started"
        )
        observed = self.observe(process)

        def flows(state):
            counts = [
                link["messages"] for link in state["links"] if link["to"] == "brightness.image"
            ]
            return counts and counts[0]

        def await_more():
            count = flows(self.state(observed, flows))
            return self.state(observed, lambda state: flows(state) > count + 20)

        await_more()
        restarts = lambda state: [each["restarts"] for each in state["modules"]]
        self.assertEqual(self.ask(process, "set filter.factor=3")[0], "ok")
        self.assertEqual(restarts(await_more()), [0, 0, 1])
        pid = self.module(self.state(observed), "filter")["pid"]
        os.kill(pid, signal.SIGKILL)
        self.state(observed, lambda state: restarts(state) == [0, 0, 2])
        await_more()
        # What it takes for the end of its input is none.
        self.assertEqual(self.ask(process, "restart camera"), ["ok"])
        self.state(observed, lambda state: restarts(state) == [1, 0, 3])
        await_more()

    def test_a_reader_that_hangs_does_not_hold_a_writer_that_is_restarted(self):
        other = "[modules.other]\nprogram = 'brightness'\ninputs.image = 'camera.left'\n"
        process = self.running_graph(GRAPH + other, last="other: started")
        observed = self.observe(process)
        flows = lambda state: min(link["messages"] for link in state["links"])
        pid = self.module(self.state(observed, flows), "other")["pid"]
        os.kill(pid, signal.SIGSTOP)
        os.kill(self.module(self.state(observed), "camera")["pid"], signal.SIGKILL)
        is_back = lambda state: self.module(state, "camera")["restarts"] == 1
        link = lambda state: state["links"][0]  # to the other reader
        count = lambda state: link(state)["messages"] - link(state)["dropped_disconnect"]
        before = count(self.state(observed, is_back))  # of the old process, or the new one
        self.state(observed, lambda state: is_back(state) and count(state) not in (0, before))
        os.kill(pid, signal.SIGCONT)

    def ask_for_a_program_that_hangs(self, process):
        """Who asks for a module whose program does not answer, and the number of that."""
        self.write("hang", "#!/bin/sh\necho $$ > asked\nexec sleep 1000\n", 0o755)
        asking = self.start("exec hc graph add z ./hang --of g.%d" % process.pid)
        asked = pathlib.Path(self.path("asked"))
        return asking, int(wait_until(lambda: asked.exists() and asked.read_text()))

    @staticmethod
    def has_ended(pid):
        try:
            stat = pathlib.Path("/proc/%d/stat" % pid).read_text()
        except OSError:
            return True
        return stat.rpartition(")")[2].split()[0] in "ZX"  # nobody has asked for its status yet

    def test_a_program_that_hangs_holds_nothing_up(self):
        process = self.running_graph()
        observed = self.observe(process)
        asking, hangs = self.ask_for_a_program_that_hangs(process)
        os.kill(self.module(self.state(observed), "camera")["pid"], signal.SIGKILL)
        self.state(observed, lambda state: self.module(state, "camera")["restarts"] == 1)
        self.assertEqual(self.ask(process, "restart brightness"), ["ok"])
        self.state(observed, lambda state: self.module(state, "brightness")["restarts"] == 1)
        self.stop(process)
        _, err = asking.communicate(timeout=WATCHDOG)
        self.assertEqual(err, b"hc graph: Invalid: the graph is stopping\n")
        self.assertTrue(self.has_ended(hangs))

    def test_a_program_that_hangs_does_not_outlive_a_killed_graph(self):
        process = self.running_graph()
        _, hangs = self.ask_for_a_program_that_hangs(process)
        process.kill()
        process.wait(WATCHDOG)
        wait_until(lambda: self.has_ended(hangs))

    def test_nobody_needs_to_read_what_is_reported(self):
        """A pager, or a terminal after Ctrl-S, keeps no module from being seen to."""
        script = 'yes "what talkers have to say" | head -n 50000 >&2\nexec sleep 1000\n'
        self.write_module("talker", script)
        # Of each no more than 256 kB a second are taken, and together more than are kept.
        names = ["talker"] + ["other%d" % i for i in range(7)]
        self.write_graph("".join("[modules.%s]\nprogram = './talker'\n" % name for name in names))

        def await_state(process, condition):
            def is_so():
                messages = self.observe(process)  # again, so that no lines come first
                state = self.state(messages)
                messages.close()
                others = all(is_silent(self.module(state, name)) for name in names[1:])
                talker = self.module(state, "talker")
                return others and condition(talker) and talker

            return wait_until(is_so)

        def is_silent(talker):
            path = pathlib.Path("/proc/%d/comm" % talker["pid"])
            return talker["pid"] and path.exists() and path.read_text() == "sleep\n"

        for reads_again in (False, True):
            process = self.run_graph(last="talker: started")
            talker = await_state(process, is_silent)
            os.kill(talker["pid"], signal.SIGKILL)
            await_state(process, lambda talker: talker["restarts"] == 1 and is_silent(talker))
            if reads_again:
                lines = self.await_lines(process, "lines dropped")
                self.assertRegex(lines[-1], r"^hc run: [0-9]+ lines dropped")
                self.stop(process)
            else:
                self.assertEqual(self.ask(process, "stop"), ["ok"])
                self.assertEqual(process.wait(timeout=WATCHDOG), 0)

    def test_results_are_in_the_order_of_the_file(self):
        """Whichever module has its own first: here the second, for which the first waits."""
        self.shell("mkfifo done")
        modules = self.write_module("first", "cat done\n" + report("result one"))
        modules += self.write_module("second", report("result two") + "echo >done\n")
        self.write_graph("restart = 'never'\n" + modules)
        out = self.shell("hc run g.toml --quiet")
        self.assertIn("\n  first: one\n  second: two\n", out)

    def test_the_status_line_stands_below_all_others(self):
        self.write_graph(GRAPH)
        name = "shown_%d" % os.getpid()
        run = 'exec script -qefc "hc run g.toml --as %s" /dev/null >shown' % name
        process = self.start(run)
        wait_until(lambda: re.search(r"\x1b\[K2 running \| \d+ messages/s", self.read("shown")))
        self.shell("hc graph stop --of " + name)
        self.assertEqual(process.wait(timeout=WATCHDOG), 0)
        # What is logged last may erase it too: then it is not drawn again.
        self.assertRegex(self.read("shown"), r"\x1b\[K([^\x1b|]*\n)?g\.toml ran for ")
        plain = self.shell("hc run g.toml --set camera.count=4 2>&1")
        self.assertNotIn("\x1b", plain)

    def write_module(self, name, script):
        """A module without ports, and its table in a graph file."""
        describe = (
            '[ "$1" = --describe ] && exec echo \'{"inputs":[],"outputs":[],"parameters":[]}\'\n'
        )
        self.write(name, "#!/bin/bash\n" + describe + script, 0o755)
        return "[modules.%s]\nprogram = './%s'\n" % (name, name)

    def test_a_signal_that_comes_again_kills_unless_it_follows_at_once(self):
        script = "trap '' TERM INT; echo deaf >&2; while :; do sleep 1; done\n"
        process = self.running_graph(self.write_module("module", script), last="module: deaf")
        messages = self.observe(process)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGINT):
            os.kill(process.pid, number)
        begun = time.monotonic()
        self.state(messages, lambda state: state["status"] == "stopping")
        self.state(messages, lambda state: time.monotonic() > begun + 1.1)
        self.assertIsNone(process.poll())
        os.kill(process.pid, signal.SIGINT)
        self.assertEqual(process.wait(WATCHDOG), -signal.SIGINT)

    def test_a_module_that_floods_its_log_is_counted(self):
        count = 200000
        script = "seq 1 %d >&2\n" % count + report("result done")
        self.write_graph("restart = 'never'\n" + self.write_module("noisy", script))
        out = self.shell("hc run g.toml")
        self.assertIn("  noisy: done\n", out)
        dropped = sum(map(int, re.findall(r"noisy: (\d+) lines dropped in \d+ s: ", self.err)))
        said = re.findall(r"(?m)^noisy: \d+$", self.err)
        self.assertEqual(len(said) + dropped, count)
        self.assertGreater(dropped, 0)
        self.assertEqual(said[:1000], ["noisy: %d" % i for i in range(1, 1001)])

    def test_who_floods_a_graph_with_commands_keeps_nobody_from_it(self):
        process = self.running_graph()
        flood = socket.socket(socket.AF_UNIX)
        self.addCleanup(flood.close)
        flood.connect("\0hypercolumn.g.%d.ask" % process.pid)
        flood.setblocking(False)
        command = b"1 0 0 0 8 0 60101 0 0 18 1\nset camera.rate=50\n" * 1000
        with self.assertRaises(BlockingIOError):  # it waits
            while True:
                flood.send(command)
        self.assertEqual(self.ask(process, "describe brightness")[0], "ok")

    def test_what_a_module_logs_steers_no_terminal(self):
        script = r"""printf 'clear \e[2J\e]0;title\a over\rwritten nul \0 bad \xff\x9b csi \xc2\x9b31m\n' >&2
printf 'windows\r\n' >&2
"""
        script += report(r"result \x1b[31mred") + "[ -e again ] || exec sleep 1000\n"
        process = self.running_graph(
            "restart = 'never'\n" + self.write_module("painter", script), last="painter: .*red$"
        )
        line = (
            r"clear \x1b[2J\x1b]0;title\x07 over\x0dwritten nul \x00 bad \xff\x9b csi \xc2\x9b31m"
        )
        state = self.state(self.observe(process), lambda state: self.module(state, "painter"))
        self.assertIn(r"\x1b[31mred", self.module(state, "painter")["last_line"])
        out, err = self.stop(process)
        self.write("again", "")
        out = self.shell("script -qefc 'hc run g.toml --quiet' /dev/null | tail -2; hc run g.toml")
        self.assertIn(r"painter: \x1b[31mred", out)
        self.assertIn("painter: " + line + "\npainter: windows\n", self.err)
        self.assertNotIn("\x1b[2J", out + self.err)

    def test_a_signal_ends_it_while_it_starts_modules(self):
        names = ["m%d" % i for i in range(200)]
        self.write_module("m", "exec sleep 1000\n")
        process = self.running_graph(
            "".join("[modules.%s]\nprogram = './m'\n" % name for name in names), last="m0: started"
        )
        _, err = self.stop(process)
        self.assertLess(err.count(": started"), 199)

    def test_idle_observers_keep_nobody_out(self):
        process = self.running_graph()
        idle = [self.observe(process) for _ in range(200)]
        states = self.shell("hc ps --json").splitlines()
        self.assertIn(process.pid, [json.loads(state)["pid"] for state in states])
        self.shell("hc graph set camera.rate=20 --of g.%d" % process.pid)
        os.kill(process.pid, signal.SIGSTOP)
        self.shell("hc ps --json", 1)
        self.assertIn("has not answered for 5 s; it may be stopped", self.err)
        os.kill(process.pid, signal.SIGCONT)
        del idle

    def test_graphs_of_other_users_do_not_count(self):
        if os.geteuid() != 0:
            self.skipTest("only root can be two users")
        other = dict(user=65534, group=65534)
        os.chmod(self.path("."), 0o777)
        try:
            self.start("exec hc --version", **other).wait(timeout=WATCHDOG)
        except PermissionError:
            self.skipTest("another user cannot run programs from here")
        self.running_graph(options="--as mine")
        theirs = self.start("exec hc run g.toml --as theirs", **other)
        self.await_lines(theirs, "brightness: started")
        listed = self.shell("hc ps").splitlines()
        self.assertTrue([line for line in listed if line.startswith("mine ")], listed)
        self.assertFalse([line for line in listed if line.startswith("theirs")], listed)
        self.shell("hc top --once --of theirs", 1)
        process = self.start("hc ps; hc graph set camera.rate=20", **other)
        out, err = process.communicate(timeout=WATCHDOG)
        self.assertEqual(process.returncode, 0, err)
        self.assertRegex(out.decode(), r"^GRAPH .*\ntheirs .*\n$")
        os.killpg(theirs.pid, signal.SIGINT)
        theirs.communicate(timeout=WATCHDOG)


if __name__ == "__main__":
    unittest.main()
