#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A recorder that is killed, full or stopped, and that keeps the last time alone. In full, with 200
kills, by HC_FULL=1."""

import os
import pathlib
import random
import re
import resource
import signal
import struct
import unittest

from harness import BUILD, WATCHDOG, wait_until
from recorded_graph import CAMERA, GRAPH, Recordings

KILLS = 200 if os.environ.get("HC_FULL") else 20


def whole_chunks(data):
    """Where the last whole chunk of a file ends, with the records behind it that are whole."""
    at, end = 8, 8
    while at + 9 <= len(data):
        (length,) = struct.unpack_from("<Q", data, at + 1)
        if at + 9 + length > len(data):
            break
        at += 9 + length
        end = at
    return end


class Recorder(Recordings):
    def test_streams_of_the_recorder_are_one_word_or_two(self):
        for equals in ("=", " "):
            self.shell("hc send 1 | hc recorder --file=x.mcap --streams%s'a=eye.left'" % equals)
            self.assertRegex(self.shell("hc info x.mcap"), r"\neye\.left +1 ")
            self.shell("rm x.mcap")

    def test_the_recorder_writes_recording_mcap_where_it_is_not_told_where(self):
        for name in ("recording", "recording_2"):
            self.shell("hc send 1 | hc recorder")
            self.assertIn("1 message in %s.mcap\n" % name, self.err)
            self.assertEqual(self.seqs(name + ".mcap"), [0])

    def test_a_recorder_that_is_not_installed_is_named(self):
        self.shell("mkdir -p own/bin own/libexec/hypercolumn; cp %s/bin/hc own/bin" % BUILD)
        for name in ("camera", "brightness", "view"):
            module = "libexec/hypercolumn/" + name
            os.symlink(BUILD / module, self.path("own/" + module))
        self.write("g.toml", GRAPH % (self.environment["HC_DATA"], 3))
        self.shell("own/bin/hc run g.toml --record x.mcap --set camera.width=-1", 2)
        wrong = '--set: module camera: parameter width: "-1" is not from 0 to 65535'
        for line in (wrong, '--record: no program "recorder"'):
            self.assertIn("hc run: error: %s\n" % line, self.err)
        self.assertEqual(self.err.count("\n"), 2, self.err)

    def test_a_killed_recorder_loses_its_last_chunk_at_most(self):
        chance = random.Random(1)
        self.noise(1600)  # 26 MB
        for kill in range(KILLS):
            name = "k%d.mcap" % kill
            path = pathlib.Path(self.path(name))
            recorder = self.start("exec hc record noise.mtp " + name)
            least = chance.randrange(0, 20 << 20)
            wait_until(lambda: path.exists() and path.stat().st_size >= least)
            os.kill(recorder.pid, signal.SIGKILL)
            recorder.wait(timeout=WATCHDOG)
            data = path.read_bytes()
            if len(data) > 8:
                self.shell("hc cat --raw %s >out.mtp; true" % name)
                out = self.read_bytes("out.mtp")
                self.assertEqual(out, self.read_bytes("noise.mtp")[: len(out)])
                # All chunks but one that was being written are read.
                self.assertLess(len(data) - whole_chunks(data), 5 << 20)
                self.assertGreater(len(out), whole_chunks(data) * 0.98 - 20000)
            path.unlink()

    def test_a_full_disk_ends_the_recording_and_not_the_robot(self):
        self.write("g.toml", GRAPH % (self.environment["HC_DATA"], 0))
        runner = self.start(
            "exec hc run g.toml --as full --record x.mcap --set camera.width=640"
            " --set camera.height=480 2>log"
        )

        def limited():  # also one that has only just begun
            for pid in self.recorders():
                resource.prlimit(pid, resource.RLIMIT_FSIZE, (8 << 20, 8 << 20))
            return "error: recording ended" in self.read("log")

        wait_until(limited)
        sent = lambda: self.sent(runner, "full")
        before = sent()
        wait_until(lambda: sent() > before + 10)  # the robot continues
        runner.send_signal(signal.SIGTERM)
        out = runner.communicate(timeout=WATCHDOG)[0].decode()
        self.assertEqual(runner.returncode, 1, self.read("log"))
        self.assertEqual(self.read("log").count("error: recording ended"), 1, self.read("log"))
        self.assertIn("File too large", self.read("log"))
        said = re.search(r"recorder: (\d+) messages in x\.mcap, (\d+) not recorded", out)
        self.assertEqual(int(said[1]), len(self.seqs("x.mcap")))
        self.assertGreater(int(said[2]), 0)
        self.assertLessEqual(os.path.getsize(self.path("x.mcap")), 8 << 20)
        seqs = self.seqs("x.mcap?stream=camera.left")  # status 0: the file is whole
        self.assertTrue(seqs)
        self.assertEqual(seqs, list(range(len(seqs))))

    def test_messages_that_are_not_kept_are_not_counted_as_recorded(self):
        self.write("g.toml", GRAPH % (self.environment["HC_DATA"], 0))
        runner = self.start("exec hc run g.toml --as one --record x.mcap --last 0.5 2>log")
        wait_until(lambda: self.recorders() and self.sent(runner, "one") > 150)
        for pid in self.recorders():
            os.kill(pid, signal.SIGUSR1)
        wait_until(lambda: os.path.exists(self.path("x_0001.mcap")))
        runner.send_signal(signal.SIGTERM)
        out = runner.communicate(timeout=WATCHDOG)[0].decode()
        said = re.search(r"recorder: (\d+) messages in x_0001.mcap, (\d+) others not kept", out)
        self.assertTrue(said, out)
        self.assertEqual(int(said[1]), len(self.seqs("x_0001.mcap")))

    def test_a_place_that_cannot_be_recorded_to_is_tried_once(self):
        self.write("g.toml", GRAPH % (self.environment["HC_DATA"], 3))
        self.shell("mkdir folder.mcap; touch plain")
        self.shell("hc run g.toml --record folder.mcap", 1)
        self.assertEqual(self.err.count("recorder: Invalid: parameter file: "), 1, self.err)
        self.assertIn("recorder: failed with status 2", self.err)
        for place in ("plain/x.mcap", "plain/kept"):
            self.shell("hc run g.toml --record " + place, 1)
            self.assertRegex(self.err, "^hc run: System: plain[^ ]*: Not a directory\n$")
        self.shell("hc run g.toml --record ''", 2)
        self.assertIn('--record takes a folder or FILE.mcap, not ""', self.err)

    def test_a_recording_that_is_removed_is_not_reported_as_there(self):
        self.write("g.toml", GRAPH % (self.environment["HC_DATA"], 0))
        for place, file in (("x.mcap", "x.mcap"), ("kept", "kept/camera.left.mtp")):
            runner = self.start("exec hc run g.toml --record %s 2>log" % place)
            wait_until(lambda: os.path.exists(self.path(file)) and self.recorders())
            self.shell("rm -r " + place)
            wait_until(lambda: "was removed or renamed while it was written" in self.read("log"))
            runner.send_signal(signal.SIGTERM)
            out = runner.communicate(timeout=WATCHDOG)[0].decode()
            self.assertEqual(runner.returncode, 1, self.read("log"))
            self.assertNotIn("messages in " + place, out)
            self.assertEqual(self.read("log").count("error: "), 1, self.read("log"))

    def test_links_use_sockets_where_shared_memory_exceeds_the_limit_of_files(self):
        self.write("g.toml", GRAPH % (self.environment["HC_DATA"], 3))
        self.shell("ulimit -f 20000; hc check g.toml && hc run g.toml")
        self.assertIn("ulimit -f is below the shared memory of links; they use sockets", self.err)
        self.assertEqual(len(self.seqs("mean.mtp")), 3)

    def test_the_last_time_is_saved_on_a_signal_and_on_a_condition(self):
        process = self.start(CAMERA + " | hc record x.mcap --last 30s")
        line = process.stderr.readline().decode()
        pid = re.search(r"keeping the last 30 s; SIGUSR1 to (\d+) saves them", line)[1]
        os.kill(int(pid), signal.SIGUSR1)
        self.assertIn("saved x_0001.mcap", process.stderr.readline().decode())
        self.end(process)
        seqs = self.seqs("x_0001.mcap")
        self.assertEqual(seqs, list(range(len(seqs))))
        self.write(
            "bump.mtp",
            "".join(
                "1 7 0 %d 8 %d 120190 0 0 1 1\n%d\n" % (i, 10**18 + i, i // 5) for i in range(9)
            ),
        )
        self.shell("hc record bump.mtp y.mcap --last 30 --when bump.mtp")
        self.assertEqual(self.seqs("y_0001.mcap"), list(range(6)))

    def test_the_recorder_alone_is_told_to_save(self):
        self.write("recorder", '#!/bin/sh\nexec hc brightness "$@"\n', 0o755)
        text = GRAPH % (self.environment["HC_DATA"], 0)
        self.write(
            "g.toml",
            text.replace("[modules.brightness]", '[modules.brightness]\nprogram = "./recorder"'),
        )
        runner = self.start("exec hc run g.toml --as one --record x.mcap --last 9s 2>log")
        sent = lambda: self.sent(runner, "one")
        wait_until(lambda: "recorder: started" in self.read("log") and sent() > 10)
        runner.send_signal(signal.SIGUSR1)
        wait_until(lambda: "saved x_0001.mcap" in self.read("log"))
        before = sent()
        wait_until(lambda: sent() > before + 10)
        runner.send_signal(signal.SIGTERM)
        runner.communicate(timeout=WATCHDOG)
        self.assertEqual(self.read("log").count("brightness: started"), 1, self.read("log"))

    def test_a_graph_whose_modules_have_failed_ends_with_its_recorder(self):
        self.write("g.toml", 'version = 1\n[modules.camera]\nparameters.source = "none.jpg"\n')
        for place in ("x.mcap", "kept"):
            self.shell("hc run g.toml --record " + place, self.run_failing())
            self.assertIn("camera: failed with status", self.err)

    def run_failing(self):
        """The status of that graph without a recorder."""
        return self.start("hc run g.toml").wait(timeout=WATCHDOG)

    def test_a_recorder_that_is_stopped_makes_nobody_wait(self):
        self.write("g.toml", GRAPH % (self.environment["HC_DATA"], 400))
        runner = self.start(
            "exec hc run g.toml --as slow --record x.mcap --set camera.count=0 2>log"
        )

        sent = lambda: self.sent(runner, "slow")
        wait_until(lambda: "recorder: started" in self.read("log") and sent() > 10)
        for pid in self.recorders():
            os.kill(pid, signal.SIGSTOP)
        before = sent()
        wait_until(lambda: sent() > before + 100)  # the others go on without it
        for pid in self.recorders():
            os.kill(pid, signal.SIGCONT)
        runner.send_signal(signal.SIGTERM)
        runner.communicate(timeout=WATCHDOG)
        self.assertEqual(runner.returncode, 0, self.read("log"))
        seqs = self.seqs("x.mcap?stream=camera.left")
        self.assertEqual(seqs, list(range(len(seqs))))
        self.assertGreater(len(seqs), 110)


if __name__ == "__main__":
    unittest.main()
