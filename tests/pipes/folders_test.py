#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Recordings in folders: full disks, killed modules, second runs."""

import os
import pathlib
import re
import signal
import unittest

from harness import WATCHDOG, wait_until
from recorded_graph import CAMERA, GRAPH, Recordings


class Folders(Recordings):
    def test_the_recorder_writes_a_folder_instead(self):
        self.shell(CAMERA + " --count 5 >in.mtp")
        for kept, continues in (("kept", False), ("kept_2", True)):
            self.shell("hc recorder --folder kept <in.mtp")
            self.assertIn("5 messages in %s\n" % kept, self.err)
            self.assertEqual("recording continues in kept_2\n" in self.err, continues, self.err)
            self.shell("cmp in.mtp %s/in.mtp" % kept)
        self.shell("hc recorder --file x.mcap --folder kept <in.mtp", 2)
        self.assertIn("give either `file` or `folder`", self.err)
        for option in ("--split 1G", "--last 3", "--when a.b"):
            self.shell("hc recorder --folder kept %s <in.mtp" % option, 2)
            self.assertIn("`split`, `keep`, `last` and `when` are for `file`", self.err)

    def test_a_folder_that_cannot_be_written_is_an_error_before_anything_starts(self):
        self.write("g.toml", GRAPH % (self.environment["HC_DATA"], 3))
        for made in ("true", "mkdir disk/kept"):
            text = made + " && mount -o remount,ro disk && hc run g.toml --record disk/kept"
            self.assertEqual(self.on_a_small_disk(text), 1, self.err)
            self.assertEqual(self.err, "hc run: System: disk/kept: Read-only file system\n")
            self.shell("rmdir disk")

    def test_a_folder_on_a_full_disk_holds_whole_messages(self):
        self.write("g.toml", GRAPH % (self.environment["HC_DATA"], 100))
        run = "hc run g.toml --record disk/kept --set camera.width=640 --set camera.height=480"
        self.assertEqual(self.on_a_small_disk(run), 1, self.err)
        error = (
            "recorder: error: recording ended: disk/kept/camera.left.mtp: write(): No space left"
        )
        self.assertEqual(self.err.count(error), 1, self.err)
        self.assertIn(error, self.out)
        self.assertEqual(self.err.count("camera: started"), 1, self.err)
        said = re.search(r"recorder: (\d+) messages in disk/kept, (\d+) not recorded", self.out)
        self.assertGreater(int(said[2]), 0)
        seqs = self.seqs("kept/kept/camera.left.mtp")  # status 0: its messages are whole
        self.assertGreater(len(seqs), 1)
        self.assertEqual(seqs, list(range(len(seqs))))
        # The robot went on.
        self.assertIn("100 messages", self.shell("hc info mean.mtp"))

    def test_a_folder_lacks_nothing_that_was_written_whoever_is_killed(self):
        self.write("g.toml", GRAPH % (self.environment["HC_DATA"], 0))
        runner = self.start("exec hc run g.toml --as kept --record kept 2>log")
        path = pathlib.Path(self.path("kept/camera.left.mtp"))
        size = lambda: path.stat().st_size if path.exists() else 0
        begin = b""
        for kill in range(4):
            module = ("camera", "recorder")[kill % 2]
            wait_until(lambda: size() > len(begin) + 100000)
            pid = self.module(self.state_of(runner, "kept"), module)["pid"]
            os.kill(pid, signal.SIGKILL)
            starts = "%s: started" % module
            wait_until(lambda: self.read("log").count(starts) == kill // 2 + 2)
            # Only the last message, then unfinished, may be lost.
            before, begin = begin, path.read_bytes()
            self.assertEqual(begin[: len(before)], before)
            begin = begin[: begin.rfind(b"\n1 ") + 1]
        wait_until(lambda: size() > len(begin) + 100000)
        runner.send_signal(signal.SIGTERM)
        runner.communicate(timeout=WATCHDOG)
        self.assertEqual(path.read_bytes()[: len(begin)], begin)
        self.seqs("kept/camera.left.mtp")  # status 0: all its messages are whole
        self.assertNotIn("kept_2", os.listdir(self.path(".")))

    def test_a_second_run_leaves_what_the_first_has_recorded(self):
        # The camera may end before a slow `brightness` has opened its file.
        ends = "ends_graph = true\n"
        graph = GRAPH.replace(ends + "[modules.brightness]\n", "[modules.brightness]\n" + ends)
        self.write("g.toml", graph % (self.environment["HC_DATA"], 3))
        for place, second in (("kept", "kept_2"), ("x.mcap", "x_2.mcap")):
            said = r"recorder: \d+ messages in %s\n"
            self.assertRegex(self.shell("hc run g.toml --record " + place), said % place)
            before = self.shell("cat %s | md5sum" % ("kept/*" if place == "kept" else place))
            out = self.shell("hc run g.toml --record %s --quiet" % place)
            self.assertRegex(out, said % second)
            self.assertIn("%s stays as it is; recording to %s\n" % (place, second), self.err)
            self.assertIn("the file stays as it is; continuing in mean_", self.err)
            after = self.shell("cat %s | md5sum" % ("kept/*" if place == "kept" else place))
            self.assertEqual(before, after)
        # So do links to files, and what verbs write.
        self.assertIn("3 messages", self.shell("hc info mean_4.mtp"))
        for name in ("y.mtp", "y.mcap"):
            self.shell("hc send 1 | hc record %s" % name)
            before = self.read_bytes(name)
            self.shell("hc send 2 | hc record %s" % name)
            self.assertIn("stays as it is; continuing in y_2", self.err)
            self.assertEqual(self.read_bytes(name), before)
            self.shell("hc info y_2" + name[1:])

    def test_a_uri_is_no_place(self):
        self.write("g.toml", GRAPH % (self.environment["HC_DATA"], 3))
        for word in ("run:9.mcap", "tcp:7001"):
            self.shell("hc run g.toml --record " + word, 2)
            self.assertIn(word + " is a link; a recording is a folder or FILE.mcap", self.err)
        self.assertIn(
            "x.mcap",
            self.shell("hc run g.toml --quiet --record ./run:9.mcap && mv run:9.mcap x.mcap; ls"),
        )

    def test_a_place_that_cannot_be_written_is_said(self):
        self.write("g.toml", GRAPH % (self.environment["HC_DATA"], 3))
        self.shell("hc run g.toml --record no/such/x.mcap", 1)
        self.assertEqual(self.err, "hc run: System: no/such: No such file or directory\n")
        # One that the file names does not keep the robot from its work.
        text = self.read("g.toml").replace("file:mean.mtp", "file:no/such/mean.mtp")
        self.write("h.toml", text.replace('"last.png"', '"file/last.png"'))
        self.write("file", "")
        out = self.shell("hc run h.toml --quiet", 1)
        for error in (
            "brightness: error: mean: recording into no/such/mean.mtp ended: open(no/such/mean.mtp): ",
            "view: error: not all images saved: file/last.png: ",
        ):
            self.assertEqual(self.err.count(error), 1, self.err)
            self.assertEqual(out.count(error), 1, out)
        # Three images, and what follows from each; `view` may miss all but one.
        self.assertRegex(out, ": 3 modules, [7-9] messages")

    def test_info_of_a_folder_says_which_file_is_cut_off(self):
        self.shell(
            "mkdir kept; hc send 1 2 3 >kept/a.mtp; hc send 1 2 3 | tee kept/b.mtp >kept/c.mtp"
        )
        os.truncate(self.path("kept/b.mtp"), os.path.getsize(self.path("kept/b.mtp")) - 2)
        out = self.shell("hc info kept", 1)
        self.assertIn("a  ", out)
        self.assertRegex(self.err, r"^hc info: Truncated: kept/b\.mtp: .*\n$")


if __name__ == "__main__":
    unittest.main()
