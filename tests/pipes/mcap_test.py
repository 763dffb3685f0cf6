#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Recordings in MCAP wherever a recording goes, those of the module recorder in folders, and a recorder
that is killed, full or too slow. In full, with 200 kills, by HC_FULL=1."""

import os
import pathlib
import random
import re
import resource
import shlex
import signal
import struct
import subprocess
import unittest

from graphs import Graphs
from harness import BUILD, WATCHDOG, wait_until
from namespaces import UNSHARE

KILLS = 200 if os.environ.get("HC_FULL") else 20
CAMERA = "hc camera $HC_DATA/aloeL.jpg --width 80 --height 60 --loop --rate 50"
GRAPH = """version = 1
[modules.camera]
parameters = { source = "%s/aloeL.jpg", width = 80, height = 60, loop = true, rate = 50, count = %d }
ends_graph = true
[modules.brightness]
inputs.image = { from = "camera.left", keep = "all" }
outputs.mean = "file:mean.mtp"
[modules.view]
parameters = { save = "last.png", window = "no" }
inputs.image = "camera.left"
"""


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


class Recordings(Graphs):
    def noise(self, count, name="noise.mtp"):
        """A file of so many grey images of 16 kB, which do not get smaller."""
        head = "1 7 0 %d 8 %d 40101 0 7 128 128\n"
        with open(self.path(name), "wb") as file:
            for i in range(count):
                file.write(
                    (head % (i, 10**18 + i * 1000)).encode() + os.urandom(128 * 128) + b"\n"
                )

    def seqs(self, name):
        """The seq of each message of a recording."""
        out = self.shell("hc cat --json '%s'" % name)
        return [int(seq) for seq in re.findall(r'"seq":(\d+)', out)]

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
            # Of what was there nothing is lost but the message that was being written.
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
        self.write("g.toml", GRAPH % (self.environment["HC_DATA"], 3))
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
        self.assertIn(": 3 modules, 9 messages", out)

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

    def on_a_small_disk(self, command):
        """The status of a command in a shell for which the folder `disk` is a disk of 2 MB; what is on
        it then is in the folder `kept`."""
        own = [*UNSHARE, "--mount", "sh", "-c"]
        mount = "mount -t tmpfs -o size=2m none disk"
        os.makedirs(self.path("disk"), exist_ok=True)
        if subprocess.run(own + [mount], cwd=self.folder.name, stderr=-1, check=False).returncode:
            self.skipTest("no mount namespaces, in which a small disk would be made")
        text = "%s && { %s; status=$?; cp -r disk kept; exit $status; }" % (mount, command)
        process = self.start("exec " + shlex.join(own + [text]))
        out, err = process.communicate(timeout=WATCHDOG)
        self.out, self.err = out.decode(), err.decode()
        return process.returncode

    def test_hc_record_on_a_disk_of_2_mb(self):
        self.noise(400)
        self.assertEqual(self.on_a_small_disk("hc record noise.mtp disk/x.mcap"), 1, self.err)
        self.assertIn("No space left on device; the recording is intact up to here", self.err)
        self.assertEqual(self.err.count("\n"), 1, self.err)
        seqs = self.seqs("kept/x.mcap")  # status 0: the file is whole
        self.assertEqual(seqs, list(range(len(seqs))))
        self.assertIn(" in ", self.shell("hc info kept/x.mcap"))
        self.shell("rm -r kept")
        self.assertEqual(self.on_a_small_disk("hc record noise.mtp disk/x.mtp"), 1, self.err)
        self.assertIn(
            "disk/x.mtp: write(): No space left on device; the recording is intact", self.err
        )
        self.assertGreater(len(self.seqs("kept/x.mtp")), 100)  # status 0: they are whole

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

    def recorders(self):
        """The recorders that run in this folder."""
        here = os.path.realpath(self.folder.name)
        found = []
        for pid in subprocess.run(["pgrep", "-x", "recorder"], stdout=-1).stdout.split():
            try:
                if os.readlink("/proc/%d/cwd" % int(pid)) == here:
                    found.append(int(pid))
            except OSError:
                pass
        return found

    def sent(self, runner, graph):
        """How many images the camera has sent."""
        links = self.state_of(runner, graph)["links"]
        return next(each["messages"] for each in links if each["to"] == "brightness.image")

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

    def test_info_of_a_folder_says_which_file_is_cut_off(self):
        self.shell(
            "mkdir kept; hc send 1 2 3 >kept/a.mtp; hc send 1 2 3 | tee kept/b.mtp >kept/c.mtp"
        )
        os.truncate(self.path("kept/b.mtp"), os.path.getsize(self.path("kept/b.mtp")) - 2)
        out = self.shell("hc info kept", 1)
        self.assertIn("a  ", out)
        self.assertRegex(self.err, r"^hc info: Truncated: kept/b\.mtp: .*\n$")

    def test_what_is_played_into_a_file_is_there_while_nothing_follows(self):
        self.shell("hc send 1 2 3 >one.mtp; mkfifo wait")
        player = self.start("(cat one.mtp; cat wait) | exec hc play - --out x.mcap")
        wait_until(lambda: "[" in self.shell("hc cat --skip --json x.mcap 2>/dev/null; true"))
        self.write("wait", "")
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
