#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Graphs: hc run and what comes of its processes."""

import os
import pathlib
import re
import signal
import unittest

from harness import BUILD, DATA, Pipes, ROOT, WATCHDOG, wait_until


class Graph(Pipes):
    def test_depth_graph_with_opencvs_matcher_is_as_good_as_opencv_called_directly(self):
        out = self.shell(
            "hc run --links %s/graphs/depth.toml --set depth.matcher=opencv"
            " --set view.save=depth.png" % ROOT
        )
        said = self.err
        direct = self.shell("%s/tests/depth_direct %s" % (BUILD, DATA))
        self.assertIn("depth_score: " + direct, said)
        self.assertRegex(out, r"^\S+depth.toml ran for .*: 5 modules, 5 messages \(\d\.\d+ MB\)\n")
        self.assertIn("\n  depth_score: " + direct, out)
        share = float(re.search(r"bad pixels ([0-9.]+) %", direct)[1])
        self.assertLess(abs(share - 2.7), 0.2)
        self.assertRegex(out, r"camera\.left → depth\.left +1 message +1\.44 MB")
        self.assertRegex(out, r"depth\.depth → view\.image +1 message +1\.92 MB")
        image = self.read_bytes("depth.png")
        self.assertEqual(image[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(image[16:24], b"\0\0\3\x8e\0\0\2\x58")  # 800 x 600, and the legend

    def test_depth_graph_is_better_with_its_own_matcher(self):
        def holes_and_bad(matcher):
            out = self.shell(
                "hc run --quiet %s/graphs/depth.toml --set depth.matcher=%s" % (ROOT, matcher)
            )
            return float(re.search(r"bad or hole ([0-9.]+) %", out)[1])

        self.assertLess(holes_and_bad("semi_global"), 0.6 * holes_and_bad("opencv"))
        self.assertEqual(os.listdir(self.folder.name), [])

    def test_one_pipe_does_the_same(self):
        out = self.shell(
            "hc camera {0}/aloeL.jpg {0}/aloeR.jpg --rectified --width 200 --height 150 | "
            "hc depth --disparities 32 | hc view --save out/ && ls out".format(DATA)
        )
        self.assertEqual(out.split(), ["1_0.png", "2_0.png"])

    def test_set_reaches_the_module_and_errors_name_it(self):
        graph = "%s/graphs/depth.toml" % ROOT
        self.shell("hc run %s --set depth.disparities=20" % graph, 2)
        self.assertIn('parameter disparities: "20" is not 16, 32, …, 256', self.err)
        self.shell("hc run %s --set camera.source=none.jpg" % graph, 1)
        self.assertIn("camera: Invalid: none.jpg: ", self.err)
        self.shell("hc run %s --set depht.disparities=16" % graph, 2)
        self.assertIn('did you mean "depth"?', self.err)
        self.shell("hc run %s --set depth.disparitis=16" % graph, 2)
        self.assertIn('did you mean "disparities"?', self.err)

    LIVE = """version = 1
restart = "failure"
[modules.camera]
parameters = { source = "%s/HappyFish.jpg", loop = true, rate = 200, width = 80, height = 60 }
[modules.brightness]
[[modules.brightness.inputs.image]]
from = "camera.left"
"""

    def run_live(self):
        self.write("live.toml", self.LIVE % DATA)
        process = self.start("exec hc run live.toml")
        lines = [process.stderr.readline() for _ in range(2)]
        self.assertEqual(lines, [b"camera: started\n", b"brightness: started\n"])
        return process

    @staticmethod
    def children(pid):
        path = pathlib.Path("/proc/%d/task/%d/children" % (pid, pid))
        return [int(word) for word in path.read_text().split()] if path.exists() else []

    def guards_and_modules(self, pid):
        """The processes of hc run: a guard for each module, and the module below it, once it runs."""

        def found():
            guards = self.children(pid)
            modules = [module for guard in guards for module in self.children(guard)]
            programs = [os.readlink("/proc/%d/exe" % module) for module in modules]
            folders = {os.path.dirname(program) for program in programs}
            run = len(modules) == 2 and folders == {str(BUILD / "libexec/hypercolumn")}
            return run and (guards, modules)

        return wait_until(found)

    def test_what_was_lost_is_reported_with_its_reason(self):
        self.write(
            "slow.toml",
            """version = 1
[modules.camera]
parameters = { source = "%s/HappyFish.jpg", loop = true, count = 30, rate = 200, width = 80, height = 60 }
[modules.brightness]
[[modules.brightness.inputs.image]]
from = "camera.left"
keep = "latest"
rate = 2
"""
            % DATA,
        )
        out = self.shell("hc run --quiet --links slow.toml")
        # Where others have the processor, newer ones overtake some before they are looked at.
        self.assertRegex(out, r"  \d+ throttled(, \d+ dropped)?\n")
        line = (
            r"camera\.left → brightness\.image .* \d+ throttled(, \d+ dropped \(newer arrived\))?\n"
        )
        self.assertRegex(out, line)

    def test_interrupt_ends_a_graph_cleanly(self):
        process = self.run_live()
        guards, modules = self.guards_and_modules(process.pid)
        self.assertEqual((len(guards), len(modules)), (2, 2))
        os.kill(process.pid, signal.SIGINT)
        out, err = process.communicate(timeout=WATCHDOG)
        self.assertEqual(process.returncode, 0, err)
        self.assertIn(b"graph: stopping\n", err)
        self.assertIn(b"live.toml ran for ", out)
        self.assertNotIn(b"reconnecting", err)
        for child in guards + modules:
            self.assertFalse(os.path.exists("/proc/%d" % child))

    def test_a_reader_that_has_enough_ends_the_graph(self):
        self.write(
            "once",
            """#!/bin/sh
[ "$1" = --describe ] && exec echo '{"inputs":[{"name":"in","types":[]}],"outputs":[],"parameters":[]}'
for word; do case $word in in=*) exec hc cat --count 1 "${word#in=}" >once.txt ;; esac; done
""",
        )
        os.chmod(self.path("once"), 0o755)
        self.write(
            "once.toml",
            """version = 1
[modules.camera]
parameters = { source = "%s/aloeL.jpg", loop = true }
[modules.once]
program = "./once"
inputs.in = "camera.left"
"""
            % DATA,
        )
        self.shell("hc run once.toml")
        self.assertIn("rgb_image", self.read("once.txt"))

    def test_a_module_without_a_description_is_named(self):
        self.write("false.toml", 'version = 1\n[modules.store]\nprogram = "/bin/false"\n')
        self.shell("hc run false.toml", 2)
        self.assertIn("false.toml:2: module store: /bin/false --describe failed with", self.err)
        self.environment["PATH"] = "%s:%s" % (self.folder.name, self.environment["PATH"])
        os.mkdir(self.path("gadget"))
        self.shell("hc gadget", 2)
        self.assertIn('unknown command or module "gadget"', self.err)

    def test_values_are_checked_before_anything_starts(self):
        graph = "%s/graphs/depth.toml" % ROOT
        self.shell("hc run %s --set camera.width=-1" % graph, 2)
        self.assertIn('--set: module camera: parameter width: "-1" is not from 0', self.err)
        self.assertNotIn("started", self.err)

    def test_a_module_that_waits_for_a_link_can_be_told_to_stop(self):
        for command in (
            "hc brightness --in 'tcp:localhost:1?wait=60'",
            "hc cat 'tcp:localhost:1?wait=60'",
        ):
            process = self.start("exec " + command)

            wait_until(lambda: self.catches_term(process.pid))
            os.kill(process.pid, signal.SIGTERM)
            _, err = process.communicate(timeout=WATCHDOG)
            self.assertEqual((process.returncode, err), (0, b""))

    def test_a_window_shows_the_image(self):
        """On a virtual display, whose memory is looked at: in a window, and over a whole monitor."""
        command = (
            "hc camera {0}/aloeL.jpg {0}/aloeR.jpg --count 0 --loop --rate 20 --width 320 "
            "--height 240".format(DATA)
        )
        display = self.start("exec Xvfb -displayfd 1 -screen 0 640x480x24 -fbdir . -nolisten tcp")
        self.environment["DISPLAY"] = ":" + display.stdout.readline().decode().strip()
        screen = pathlib.Path(self.path("Xvfb_screen0"))

        def pixels():
            memory = screen.read_bytes()[-640 * 480 * 4 :]
            return [memory[i : i + 3] for i in range(0, len(memory), 4)]

        for options in ("", "--monitor 0 --stereo top_bottom"):
            view = self.start("%s | hc view --window yes %s" % (command, options))

            def photograph():
                self.assertIsNone(view.poll(), view.poll() is not None and view.stderr.read())
                shown = pixels()
                middle = shown[170], shown[470], shown[-470], shown[-170]  # first and last row
                return len(set(shown)) > 1000 and (b"\0\0\0" not in middle or not options)

            wait_until(photograph)
            self.end(view)
        self.shell("hc view --window yes --monitor 3", 1)
        self.assertEqual(self.err, "view: window: no monitor 3, only 0\n")
        self.end(display)

    def test_a_killed_runner_leaves_nothing_that_a_wrapper_started(self):
        """Beside the module itself: a process in the background, and one in its own session."""
        mark = "1000.%d" % os.getpid()
        self.write(
            "wrapper",
            """#!/bin/sh
[ "$1" = --describe ] && exec echo '{"inputs":[],"outputs":[],"parameters":[]}'
sleep %s & setsid sleep %s & echo ready >&2; sleep %s; echo behind
"""
            % (mark, mark, mark),
        )
        os.chmod(self.path("wrapper"), 0o755)
        self.write("wrapper.toml", 'version = 1\n[modules.wrapper]\nprogram = "./wrapper"\n')

        def sleepers():
            found = []
            for process in pathlib.Path("/proc").glob("[0-9]*"):
                try:
                    words = (process / "cmdline").read_bytes().split(b"\0")
                    if words[:2] == [b"sleep", mark.encode()]:
                        found.append(int(process.name))
                except OSError:
                    pass  # it has ended meanwhile
            return found

        for number in (signal.SIGKILL, signal.SIGTERM):
            process = self.start("exec hc run wrapper.toml")
            for line in (b"wrapper: started\n", b"wrapper: ready\n"):
                self.assertEqual(process.stderr.readline(), line)
            wait_until(lambda: len(sleepers()) == 3)
            children = self.children(process.pid)
            self.assertEqual(len(children), 1)
            os.kill(process.pid, number)
            process.wait(timeout=WATCHDOG)
            wait_until(lambda: not sleepers())
            for child in children:
                wait_until(lambda: not os.path.exists("/proc/%d/exe" % child))


if __name__ == "__main__":
    unittest.main()
