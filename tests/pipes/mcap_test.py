#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Recordings in MCAP wherever a recording goes, and files that are cut off."""

import os
import re
import unittest

from harness import wait_until, WATCHDOG
from recorded_graph import CAMERA, GRAPH, Recordings


class Mcap(Recordings):
    def test_a_recording_goes_through_mcap_and_back_byte_for_byte(self):
        self.shell(
            "(%s --count 5; hc send hello; hc send --type position 0.1 0.2 0.3;"
            " hc send --encoding zstd 1 2 3; hc send --image $HC_DATA/aloeL.jpg --encoding jpeg)"
            " >r.mtp" % CAMERA
        )
        self.shell("hc record r.mtp x.mcap && hc record x.mcap copy.mtp && cmp r.mtp copy.mtp")
        self.shell("hc record x.mcap y.mcap && hc cat --raw y.mcap | cmp - r.mtp")
        self.shell("hc play --speed max x.mcap | cmp - r.mtp")
        self.shell("hc play --speed max r.mtp --out z.mcap && hc cat --raw z.mcap | cmp - r.mtp")
        self.assertEqual(
            self.shell("hc cat --json x.mcap | md5sum"), self.shell("hc cat --json r.mtp | md5sum")
        )
        self.assertRegex(
            self.shell("hc info x.mcap"),
            r"r +5 .* sensor_msgs/msg/Image\nr.src_0 +3 .*\n8 messages",
        )
        self.shell("hc record x.mcap nothing.mtp --in 'x.mcap?stream=l'", 1)
        self.assertIn('no stream "l"', self.err)

    def test_a_graph_is_recorded_into_one_file(self):
        self.write("g.toml", GRAPH % (self.environment["HC_DATA"], 30))
        out = self.shell("hc run g.toml --record x.mcap --quiet")
        self.assertRegex(out, r"recorder: \d+ messages in x\.mcap\n")
        out = self.shell("hc info x.mcap")
        for line in (
            r"camera\.left +30 .* sensor_msgs/msg/Image\n",
            r"brightness\.mean +30 .* std_msgs/msg/Float64MultiArray\n",
        ):
            self.assertRegex(out, line)
        self.assertEqual(self.seqs("x.mcap?stream=camera.left"), list(range(30)))
        # A copy has the same streams.
        self.shell("hc record x.mcap copy.mcap")
        self.assertEqual(self.seqs("copy.mcap?stream=camera.left"), list(range(30)))
        rows = r"(?m)^(\S+\.\S+) +(\d+) "
        self.assertEqual(re.findall(rows, self.shell("hc info copy.mcap")), re.findall(rows, out))
        # Any module takes it, and the result is the recorded one.
        self.shell("hc cat --raw 'x.mcap?stream=camera.left' | hc brightness | hc cat --json >a")
        strip = "sed 's/.*\"elements\"//'"
        self.shell(
            "hc cat --json 'x.mcap?stream=brightness.mean' | %s >b; %s <a | cmp - b"
            % (strip, strip)
        )
        # The graph, its modules and its log stand beside.
        data = self.read_bytes("x.mcap")
        for words in (b"hypercolumn.graph", b"hypercolumn.module.camera", b"parameter.rate"):
            self.assertIn(words, data)

    def test_the_last_output_of_a_chain_is_recorded_and_seen_without_a_link(self):
        text = (GRAPH % (self.environment["HC_DATA"], 0)).replace(
            'outputs.mean = "file:mean.mtp"', ""
        )
        self.write("g.toml", text.replace('save = "last.png", ', ""))
        name = "chain_%d" % os.getpid()
        process = self.start("exec hc run g.toml --as %s --record kept" % name)
        lines = self.await_lines(process, "view: started")
        self.assertIn("not recorded: camera.right;", "\n".join(lines))
        self.shell("hc cat brightness.mean --of %s --count 1" % name)
        self.stop(process)
        self.assertTrue(self.seqs("kept/brightness.mean.mtp"))

    def test_hc_record_on_a_disk_of_2_mb(self):
        self.noise(400)
        self.assertEqual(self.on_a_small_disk("hc record noise.mtp disk/x.mcap"), 1, self.err)
        self.assertIn("No space left on device; the messages written before are kept", self.err)
        self.assertEqual(self.err.count("\n"), 1, self.err)
        seqs = self.seqs("kept/x.mcap")  # status 0: the file is whole
        self.assertEqual(seqs, list(range(len(seqs))))
        self.assertIn(" in ", self.shell("hc info kept/x.mcap"))
        self.shell("rm -r kept")
        self.assertEqual(self.on_a_small_disk("hc record noise.mtp disk/x.mtp"), 1, self.err)
        self.assertIn(
            "disk/x.mtp: write(): No space left on device; the messages written before are kept",
            self.err,
        )
        self.assertGreater(len(self.seqs("kept/x.mtp")), 100)  # status 0: they are whole

    def test_a_graph_that_cannot_run_leaves_the_last_recording(self):
        self.write("x.mcap", "kept")
        self.write("g.toml", "version = 1\n[modules.camer]\n")
        self.shell("hc run g.toml --record x.mcap", 2)
        self.assertEqual(self.read("x.mcap"), "kept")
        self.write("g.toml", GRAPH % (self.environment["HC_DATA"], 3))
        self.shell("hc run g.toml --quiet --record x.mcap --last 9")
        self.shell("hc run g.toml --quiet --record x.mcap --split 1G")
        self.assertEqual(self.read("x.mcap"), "kept")
        self.shell("hc run g.toml --quiet --record x.mcap")
        self.assertEqual(self.read("x.mcap"), "kept")
        self.assertEqual(self.seqs("x_2.mcap?stream=camera.left"), list(range(3)))

    def test_info_of_a_file_without_its_end(self):
        self.noise(2000)
        self.shell("hc record noise.mtp x.mcap")
        whole = self.read_bytes("x.mcap")
        self.write("cut.mcap", whole[: len(whole) * 2 // 3])
        out = self.shell("hc info cut.mcap", 1)
        self.assertRegex(out, r"noise +1[0-9]{3} .* sensor_msgs/msg/Image\n")
        self.assertIn("the file is truncated", self.err)
        self.shell("hc record cut.mcap mended.mcap", 1)
        self.assertIn("cut.mcap: MCAP: the file is truncated", self.err)
        self.assertIn(out.split("\n")[1], self.shell("hc info mended.mcap"))
        self.shell("hc cat --skip --raw cut.mcap >mended.mtp")
        self.assertEqual(self.err.count("the file is truncated"), 1, self.err)

    def test_what_is_played_into_a_file_is_there_while_nothing_follows(self):
        self.shell("hc send 1 2 3 >one.mtp; mkfifo wait")
        player = self.start("(cat one.mtp; cat wait) | exec hc play - --out x.mcap")
        wait_until(lambda: "[" in self.shell("hc cat --skip --json x.mcap 2>/dev/null; true"))
        open(self.path("wait"), "w").close()
        player.communicate(timeout=WATCHDOG)
        self.assertEqual(player.returncode, 0)
        self.assertEqual(self.seqs("x.mcap"), [0])

    def test_what_is_no_recording_is_refused_in_a_line(self):
        self.write("x.mcap", "1 7 0 0 8 0 10390 1 3 1 1\n1 2 3\n")
        for command in ("hc cat x.mcap", "hc info x.mcap", "hc play x.mcap"):
            self.shell(command, 1)
            self.assertIn("not an MCAP file", self.err)
            self.assertEqual(self.err.count("\n"), 1)
        self.shell("hc send 1 | hc record y.mtp --split 1G", 2)
        self.shell("hc send 1 | hc record y.mcap --split x", 2)
        self.assertIn('--split: "x" is not a number of bytes, such as 1G', self.err)
        self.shell("hc send 1 | hc record y.mcap --split 99999999999G", 2)
        self.shell("hc send 1 | hc recorder --split x", 2)
        self.assertIn('split: "x" is not a number of bytes', self.err)
        self.shell("hc send 1 | hc record y.mcap --keep 1G", 2)


if __name__ == "__main__":
    unittest.main()
