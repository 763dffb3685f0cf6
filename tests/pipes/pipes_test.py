#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The product with real programs around it: shells, netcat, awk, NumPy, gnuplot, Octave.

    pipes_test.py BUILD_FOLDER [TEST …]
"""

import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).parents[2]
DATA = os.environ.get("HC_DATA", "/usr/share/doc/opencv-doc/examples/data")
BUILD = None  # set from the command line
PYTHON = "/usr/bin/python3"  # the one that the system's NumPy belongs to
WATCHDOG = 100  # seconds after which a program hangs


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def wait_until(condition):
    """Waits for an event that gives no notice."""
    end = time.monotonic() + WATCHDOG
    while not condition():
        assert time.monotonic() < end, "nothing happened"
        time.sleep(0.01)


def listens(port):
    """Whether somebody listens on a port, asked of the kernel and not by connecting."""
    wanted = "0100007F:%04X 00000000:0000 0A" % port
    return wanted in pathlib.Path("/proc/net/tcp").read_text()


class Pipes(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.environment = dict(os.environ, HC_DATA=DATA)
        self.environment["PATH"] = "%s/bin:%s" % (BUILD, os.environ["PATH"])
        self.environment.pop("DISPLAY", None)

    def start(self, command, **options):
        options = dict(dict(stdin=-3, stdout=-1, stderr=-1), **options)
        process = subprocess.Popen(
            ["bash", "-o", "pipefail", "-c", command],
            cwd=self.folder.name,
            env=self.environment,
            start_new_session=True,
            **options,
        )
        self.addCleanup(self.end, process)
        return process

    def end(self, process):
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()

    def shell(self, command, status=0, data=b""):
        process = self.start(command, stdin=-1)
        out, err = process.communicate(data, timeout=WATCHDOG)
        self.assertEqual(process.returncode, status, (command, out[-500:], err[-2000:]))
        self.err = err.decode()
        return out.decode(errors="replace")

    def path(self, name):
        return os.path.join(self.folder.name, name)


class Programs(Pipes):
    def test_a_person_types_a_position_into_netcat(self):
        port = free_port()
        cat = self.start("hc cat --count 1 tcp-listen:%d" % port)
        wait_until(lambda: listens(port))
        self.shell("nc -N localhost %d" % port, data=b"1 7 0 1 8 0 10390 1 3 1 1\n0.1 0.2 0.3\n")
        out, _ = cat.communicate(timeout=WATCHDOG)
        self.assertEqual(
            out.decode(), "position 1 x 1 of 3 f64, src 7 seq 1 mode 1 in head\n  0.1 0.2 0.3\n"
        )

    def test_telnet_line_ends_are_taken(self):
        out = self.shell("hc cat --json", data=b"1 7 0 1 8 0 10390 1 3 1 1 \r\n0.1 0.2 0.3\r\n")
        self.assertEqual(json.loads(out)["elements"], [[[0.1, 0.2, 0.3]]])

    def test_head_shows_a_readable_header(self):
        out = self.shell("hc camera %s/aloeL.jpg | head -c 60 | head -n 1; true" % DATA)
        self.assertRegex(out, r"^1 1 0 0 8 [0-9]{19} 30301 0 7 1282 1110$")

    def test_a_line_of_awk_is_a_module(self):
        awk = "awk 'NR % 2 { print; next } { print $1 * 10, $2, $3 }'"
        out = self.shell("hc send --type position --src 7 0.1 0.2 0.3 | %s | hc cat --json" % awk)
        self.assertEqual(json.loads(out)["elements"], [[[1, 0.2, 0.3]]])

    def test_brightness_in_awk_is_brightness_in_cpp(self):
        camera = "hc camera %s/aloeL.jpg --width 80 --height 60" % DATA
        awk = "awk -f %s/modules/brightness/brightness.awk" % ROOT
        ours = json.loads(self.shell(camera + " | hc brightness | hc cat --json"))
        theirs = json.loads(self.shell("%s --encoding text | %s | hc cat --json" % (camera, awk)))
        self.assertEqual(ours["elements"], theirs["elements"])
        self.assertGreater(ours["elements"][0][0], 50)
        self.assertNotEqual(ours["time"], 0)

    def send_table(self):
        self.shell("hc send --width 3 1 2.5 -3 4e-7 nan 6 > table.mtp")

    def test_numpy_reads_text_elements(self):
        self.send_table()
        out = self.shell(
            PYTHON + ' -c \'import numpy; m = numpy.loadtxt("table.mtp", skiprows=1);'
            "print(m.shape, m[0, 1], m[1, 0], m[1, 1])'"
        )
        self.assertEqual(out, "(2, 3) 2.5 4e-07 nan\n")

    def test_octave_reads_text_elements(self):
        self.send_table()
        octave = (
            "m = dlmread('table.mtp', ' ', 1, 0); printf('%d %d %g %g\\n', size(m), m(1,2), m(2,3))"
        )
        out = self.shell('octave-cli --no-init-file --quiet --eval "%s"' % octave)
        self.assertEqual(out, "2 3 2.5 6\n")

    def test_gnuplot_reads_text_elements(self):
        self.shell("hc send --type position 0 0 1 1 10 2 2 20 3 --width 1 > path.mtp")
        out = self.shell(
            "gnuplot -e \"stats 'path.mtp' skip 1 using 2 nooutput; print STATS_max, STATS_records\" 2>&1"
        )
        self.assertEqual(out.split(), ["20.0", "3"])

    def test_a_file_a_pipe_and_tee_are_peers(self):
        out = self.shell("hc send --text hello | tee copy.mtp | hc cat; cat copy.mtp | hc cat")
        self.assertEqual(out.count("  hello\n"), 2)


class Tool(Pipes):
    def test_exit_status_and_one_line(self):
        for command, status, line in [
            ("hc cat /nowhere", 1, "hc cat: NotFound: /nowhere: open(/nowhere): No such file"),
            ("hc nonsense", 2, 'hc: no verb and no module "nonsense"; see hc --help'),
            ("hc cat --nonsense", 2, "hc cat: The following argument was not expected: --nonsense"),
            ("hc play", 2, "hc play: file is required"),
            ("hc run missing.toml", 1, "hc run: NotFound: missing.toml: cannot be read"),
            ("hc camera nothing.jpg", 1, "camera: nothing.jpg: cannot be opened"),
            (
                "echo rubbish | hc cat",
                1,
                'hc cat: Malformed: -: R5 version: "rubbish" is not an integer',
            ),
            (
                "hc send --type position 1 2",
                2,
                "hc send: Usage: 2 numbers do not make elements of 3",
            ),
            ("hc camra", 2, 'hc: no verb and no module "camra", did you mean "camera"?'),
            ("hc describe camra", 1, 'hc describe: NotFound: no module "camra", did you mean'),
            ("hc send", 2, "hc send: Usage: nothing to send"),
            ("hc send --text a 1", 2, "hc send: Usage: --text and numbers do not go together"),
            ("hc send --text a --width 1", 2, "hc send: Usage: --scalar, --components and --width"),
            ("hc send --coord head 1", 2, 'hc send: --coord: "head" is not a whole number'),
            ("hc cat --count -1", 2, 'hc cat: --count: "-1" is not a whole number'),
            ("hc cat inproc:x", 2, "hc cat: Usage: inproc:x: inproc links threads"),
            (
                "DISPLAY=:9797 hc view --window yes",
                1,
                "view: window: there is no display",
            ),
            ("hc send --type position 1 2 x", 1, 'hc send: Malformed: elements: R27: "x" is not'),
        ]:
            with self.subTest(command):
                self.shell(command, status)
                self.assertTrue(self.err.startswith(line), self.err)
                self.assertEqual(self.err.count("\n"), 1, self.err)

    def test_send_makes_what_it_is_told(self):
        out = self.shell(
            "hc send --src 3 --dst -1 --seq 9 --ttl 2 --time 5 --mode 4 --coord 1003 --encoding zstd"
            " --type transformation --scalar f32 --width 2 1 0 0 1 | hc cat --json"
        )
        told = json.loads(out)
        for key, value in dict(
            src=3, dst=-1, seq=9, ttl=2, time=5, mode=4, coord=1003, width=2, height=2
        ).items():
            self.assertEqual(told[key], value)
        self.assertEqual((told["encoding"], told["scalar"]), ("zstd", "f32"))
        self.assertEqual(told["elements"], [[1, 0], [0, 1]])

    def test_send_takes_pictures_and_arrays(self):
        self.shell(
            PYTHON
            + ' -c \'import numpy; numpy.save("a.npy", numpy.arange(6, dtype="<f4").reshape(2, 3))\''
        )
        out = json.loads(self.shell("hc send --npy a.npy --type intensity_image | hc cat --json"))
        self.assertEqual(out["type"], "intensity_image")
        out = json.loads(self.shell("hc send --npy a.npy | hc cat --json"))
        self.assertEqual((out["type"], out["elements"]), ("table", [[0, 1, 2], [3, 4, 5]]))
        out = self.shell("hc send --picture %s/aloeL.jpg --src 4 --encoding jpeg | hc info" % DATA)
        self.assertIn("1282x1110 rgb_image 3 x u8, jpeg", out)

    def record(self):
        """Ten positions, 20 ms apart, of two senders; one lost."""
        lines = []
        for i in range(10):
            lines.append(
                "1 7 0 %d 8 %d 10390 0 3 1 1\n%d 0 0\n" % (i, 10**18 + i * 20_000_000, i)
            )
            if i != 4:
                lines.append(
                    "1 8 0 %d 8 %d 120190 0 0 1 1\n%d\n" % (i, 10**18 + i * 20_000_000, i)
                )
        pathlib.Path(self.path("r.mtp")).write_text("".join(lines))

    def test_info_tells_rates_gaps_and_sizes(self):
        self.record()
        out = self.shell("hc info r.mtp")
        self.assertRegex(out, r" 7 +10 +240 B +0\.180 s +50 Hz +0 +0  1x1 position 3 x f64, text")
        self.assertRegex(out, r" 8 +9 +72 B +0\.180 s +44\.4 Hz +1 +0  1x1 table 1 x f64, text")
        self.assertIn("19 messages", out)

    def test_record_and_play_give_the_same_bytes(self):
        self.record()
        self.shell("hc play --speed max r.mtp | hc record copy.mtp")
        self.shell("cmp r.mtp copy.mtp")
        out = self.shell("hc play --speed max --from 0.05 --to 0.1 r.mtp | hc cat --json")
        self.assertEqual([json.loads(line)["seq"] for line in out.splitlines()], [3, 3, 4, 5, 5])
        out = self.shell("hc play --speed max --loop r.mtp | hc cat --json --count 50")
        self.assertEqual(out.count("\n"), 50)

    def test_play_keeps_the_time_of_the_recording(self):
        self.record()
        begin = time.monotonic()
        self.shell("hc play r.mtp > /dev/null")
        self.assertGreaterEqual(time.monotonic() - begin, 0.18)
        begin = time.monotonic()
        self.shell("hc play --speed 0.5 r.mtp > /dev/null")
        self.assertGreaterEqual(time.monotonic() - begin, 0.36)

    def test_a_truncated_file_gives_what_is_whole(self):
        self.record()
        whole = pathlib.Path(self.path("r.mtp")).read_bytes()
        pathlib.Path(self.path("cut.mtp")).write_bytes(whole[:-3])
        out = self.shell("hc cat --json cut.mtp", 1)
        self.assertEqual(out.count("\n"), 18)
        self.assertIn(
            "R2 stream: truncated after 18 messages, at byte %d" % (len(whole) - 3), self.err
        )

    def test_skip_goes_on_behind_damage(self):
        self.record()
        whole = pathlib.Path(self.path("r.mtp")).read_text().splitlines(True)
        whole[4] = whole[4].replace("10390", "99999")
        pathlib.Path(self.path("bad.mtp")).write_text("".join(whole))
        out = self.shell("hc cat --json --skip bad.mtp")
        self.assertEqual(out.count("\n"), 18)
        self.assertIn("R20 info", self.err)
        self.assertEqual(self.shell("hc cat --json bad.mtp", 1).count("\n"), 2)

    def test_output_that_fails_is_told(self):
        self.record()
        for command in (
            "hc cat r.mtp >/dev/full",
            "hc cat --raw --skip r.mtp >/dev/full",
            "hc info r.mtp >/dev/full",
            "hc camera --help >/dev/full",
            "hc describe brightness >/dev/full",
        ):
            with self.subTest(command):
                self.shell(command, 1)
                self.assertIn("No space left on device", self.err)

    def test_busy_verbs_can_be_told_to_stop(self):
        self.record()
        for command in (
            "hc play r.mtp --loop --speed max >/dev/null",
            "hc play r.mtp --loop --speed max --out tcp-listen:%d" % free_port(),
            "hc cat /dev/zero --skip --limit 10",
        ):
            with self.subTest(command):
                process = self.start("exec " + command)
                wait_until(lambda: self.catches_term(process.pid))
                os.kill(process.pid, signal.SIGTERM)
                process.communicate(timeout=WATCHDOG)
                self.assertIn(process.returncode, (0, 1))

    @staticmethod
    def catches_term(pid):
        text = pathlib.Path("/proc/%d/status" % pid).read_text()
        return int(re.search(r"SigCgt:\t([0-9a-f]+)", text)[1], 16) >> (signal.SIGTERM - 1) & 1

    def test_a_loop_over_nothing_ends(self):
        self.shell(": >empty.mtp; hc play empty.mtp --loop")
        self.record()
        self.shell("hc play r.mtp --loop --from 100")

    def test_record_does_not_empty_what_it_reads(self):
        self.record()
        before = pathlib.Path(self.path("r.mtp")).read_bytes()
        for command in ("hc record r.mtp --in r.mtp", "hc record ./r.mtp < r.mtp"):
            self.shell(command, 2)
            self.assertIn("is the file that is written", self.err)
        self.assertEqual(pathlib.Path(self.path("r.mtp")).read_bytes(), before)
        self.shell(
            "hc record 'odd?name&=.mtp' --in r.mtp --in r.mtp && hc play --speed max 'odd?name&=.mtp' | hc info"
        )

    def test_record_names_the_link_that_is_wrong(self):
        self.record()
        pathlib.Path(self.path("bad.mtp")).write_text("rubbish\n")
        self.shell(": >empty.mtp; hc record x.mtp --in empty.mtp --in bad.mtp --in r.mtp", 1)
        self.assertIn("bad.mtp: R5", self.err)

    def test_a_picture_gets_the_header_that_was_asked_for(self):
        out = self.shell(
            "hc send --picture %s/aloeL.jpg --src 3 --dst 5 --seq 9 --ttl 2 --time 5 --mode 4 --coord 8"
            " | hc cat --raw | head -n 1" % DATA
        )
        self.assertEqual(out, "1 3 5 9 2 5 30301 4 8 1282 1110\n")
        self.shell("hc send --picture none.jpg", 1)
        self.assertEqual(self.err.count("\n"), 1)

    def test_hostile_messages_end_with_one_line(self):
        head = "1 7 0 0 8 0 "
        for line, told in [
            (head + "30301 1 7 9223372036854775808 1", "R15 width"),
            (head + "30301 1 7 -1 1", "R15 width"),
            (head + "30301 1 7 2147483647 2147483647", "R24 width"),
            (head + "30301 1 7 1", "R4 height"),
            (head + "30301 1 7 1 1 1", "R4 header"),
            (head + "9" * 10000, "R3 header"),
            (head + "0x7 1 7 1 1", "R5 info"),
            (head + "30301 1 7 1\0 1", "R5 width"),
            (head + "40102 1 7 16000 16000\n22\n" + "x" * 22, "R36 elements"),
        ]:
            with self.subTest(told):
                self.shell("hc cat", 1, line.encode() + b"\n")
                self.assertRegex(self.err, r"^hc cat: [A-Za-z]+: -: %s: .*, at byte \d+\n$" % told)
        self.shell("head -c 1000000000 /dev/zero | tr '\\0' 1 | hc cat; exit ${PIPESTATUS[2]}", 1)
        self.assertIn("R3 header", self.err)

    def test_describe_is_json(self):
        for module in ("camera", "depth", "view", "brightness", "depth_score"):
            told = json.loads(self.shell("hc describe " + module))
            self.assertEqual(told["name"], module)
            self.assertIn(told["summary"], self.shell("hc %s --help" % module))

    def test_interrupt_ends_a_verb_cleanly(self):
        port = free_port()
        for command in ("hc cat tcp-listen:%d" % port, "hc record x.mtp --in tcp-listen:%d" % port):
            process = self.start("exec " + command)
            wait_until(lambda: listens(port))
            os.kill(process.pid, signal.SIGINT)
            process.communicate(timeout=WATCHDOG)
            self.assertEqual(process.returncode, 0, command)


class Graph(Pipes):
    def write(self, name, text):
        pathlib.Path(self.path(name)).write_text(text)

    def test_depth_graph_is_as_good_as_opencv_called_directly(self):
        out = self.shell("hc run %s/graphs/depth.toml" % ROOT)
        said = self.err
        direct = self.shell("%s/tests/depth_direct %s" % (BUILD, DATA))
        self.assertIn("depth_score: " + direct, said)
        share = float(re.search(r"bad pixels ([0-9.]+) %", direct)[1])
        self.assertLess(abs(share - 2.7), 0.2)
        self.assertRegex(out, r"camera\.left -> depth\.left +1 message +1\.44 MB")
        self.assertRegex(out, r"depth\.depth -> view\.image +1 message +1\.92 MB")
        picture = pathlib.Path(self.path("depth.png")).read_bytes()
        self.assertEqual(picture[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(picture[16:24], b"\0\0\3\x20\0\0\2\x58")  # 800 x 600

    def test_one_pipe_does_the_same(self):
        out = self.shell(
            "hc camera {0}/aloeL.jpg {0}/aloeR.jpg --rectified --width 200 --height 150 | "
            "hc depth --disparities 32 | hc view --save out/ && ls out".format(DATA)
        )
        self.assertEqual(out.split(), ["1_0.png", "2_0.png"])

    def test_set_reaches_the_module_and_errors_name_it(self):
        graph = "%s/graphs/depth.toml" % ROOT
        self.shell("hc run %s --set depth.disparities=20" % graph, 1)
        self.assertIn("depth: disparities is not a multiple of 16", self.err)
        self.assertIn("hc run: Closed: module depth: failed with status 1", self.err)
        self.shell("hc run %s --set camera.source=none.jpg" % graph, 1)
        self.assertIn("camera: none.jpg: cannot be opened", self.err)
        self.shell("hc run %s --set depht.disparities=16" % graph, 2)
        self.assertIn('did you mean "depth"?', self.err)
        self.shell("hc run %s --set depth.disparitis=16" % graph, 2)
        self.assertIn('did you mean "disparities"?', self.err)

    LIVE = """
[modules.camera]
parameters = { source = "%s/aloeL.jpg", loop = true, rate = 200, width = 80, height = 60 }
[modules.brightness]
[modules.store]
program = "./store"
[[links]]
from = "camera.left"
to = "brightness.image"
"""

    def run_live(self):
        self.write("live.toml", re.sub(r"\[modules.store\]\n.*\n", "", self.LIVE % DATA))
        process = self.start("exec hc run live.toml")
        lines = []
        while len(lines) < 2:
            lines.append(process.stderr.readline().decode())
        self.assertEqual(lines, ["camera: started\n", "brightness: started\n"])
        return process

    @staticmethod
    def children(pid):
        path = pathlib.Path("/proc/%d/task/%d/children" % (pid, pid))
        return [int(word) for word in path.read_text().split()] if path.exists() else []

    def test_interrupt_ends_a_graph_cleanly(self):
        process = self.run_live()
        children = self.children(process.pid)
        self.assertEqual(len(children), 2)
        os.kill(process.pid, signal.SIGINT)
        out, err = process.communicate(timeout=WATCHDOG)
        self.assertEqual(process.returncode, 0, err)
        self.assertIn(b"graph: stopping\n", err)
        self.assertIn(b"camera.left -> brightness.image", out)
        for child in children:
            self.assertFalse(os.path.exists("/proc/%d" % child))

    def test_a_killed_runner_leaves_nothing(self):
        process = self.run_live()
        children = self.children(process.pid)
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
        is_gone = lambda child: not os.path.exists("/proc/%d/exe" % child) or not os.readlink(
            "/proc/%d/exe" % child
        ).startswith(str(BUILD))
        for child in children:
            wait_until(lambda: is_gone(child))

    def test_a_killed_module_is_named_and_ends_the_graph(self):
        process = self.run_live()
        os.kill(self.children(process.pid)[1], signal.SIGKILL)
        _, err = process.communicate(timeout=WATCHDOG)
        self.assertEqual(process.returncode, 1)
        self.assertIn(b"brightness: killed by signal 9\n", err)

    def test_a_program_that_is_no_module_is_refused(self):
        self.write("bad.toml", '[modules.store]\nprogram = "/bin/true"\n')
        self.shell("hc run bad.toml", 2)
        self.assertIn("bad.toml:1: module store: /bin/true --describe prints no", self.err)
        self.write("bad.toml", "[modules.camra]\n")
        self.shell("hc run bad.toml", 2)
        self.assertIn('bad.toml:1: no program "camra", did you mean "camera"?', self.err)

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
            """[modules.camera]
parameters = { source = "%s/aloeL.jpg", loop = true }
[modules.once]
program = "./once"
[[links]]
from = "camera.left"
to = "once.in"
"""
            % DATA,
        )
        self.shell("hc run once.toml")
        self.assertIn("rgb_image", pathlib.Path(self.path("once.txt")).read_text())

    def test_a_module_without_a_description_is_named(self):
        self.write("false.toml", '[modules.store]\nprogram = "/bin/false"\n')
        self.shell("hc run false.toml", 2)
        self.assertIn("false.toml:1: module store: /bin/false --describe failed with", self.err)
        self.environment["PATH"] = "%s:%s" % (self.folder.name, self.environment["PATH"])
        os.mkdir(self.path("gadget"))
        self.shell("hc gadget", 2)
        self.assertIn('no verb and no module "gadget"', self.err)

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

            wait_until(lambda: Tool.catches_term(process.pid))
            os.kill(process.pid, signal.SIGTERM)
            _, err = process.communicate(timeout=WATCHDOG)
            self.assertEqual((process.returncode, err), (0, b""))

    def test_a_window_shows_the_picture(self):
        """On a virtual display, whose memory is looked at."""
        command = (
            "hc camera %s/aloeL.jpg --count 0 --loop --rate 20 --width 320 --height 240" % DATA
        )
        display = self.start("exec Xvfb -displayfd 1 -screen 0 640x480x24 -fbdir . -nolisten tcp")
        self.environment["DISPLAY"] = ":" + display.stdout.readline().decode().strip()
        view = self.start("%s | hc view --window yes" % command)
        screen = pathlib.Path(self.path("Xvfb_screen0"))

        def colours():
            self.assertIsNone(view.poll(), view.poll() is not None and view.stderr.read())
            pixels = screen.read_bytes()[-640 * 480 * 4 :]
            return {pixels[i : i + 3] for i in range(0, len(pixels), 4)}

        wait_until(lambda: len(colours()) > 1000)  # a photograph, not a grey window
        self.end(view)
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
        self.write("wrapper.toml", '[modules.wrapper]\nprogram = "./wrapper"\n')

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


class Documents(Pipes):
    """Every command of the README and the documents, as it stands there."""

    def commands(self, name):
        text = (ROOT / name).read_text()
        text = text.replace("7311", str(free_port()))  # may be somebody else's just now
        blocks = re.findall(r"```sh\n(.*?)```", text, re.S)
        self.assertTrue(blocks)
        return [block for block in blocks if "./dev" not in block]

    def run_document(self, name):
        pathlib.Path(self.path("graphs")).symlink_to(ROOT / "graphs")
        pathlib.Path(self.path("modules")).symlink_to(ROOT / "modules")
        pathlib.Path(self.path("data")).symlink_to(DATA)
        for block in self.commands(name):
            with self.subTest(block):
                expected = "".join(
                    line[2:] + "\n" for line in block.splitlines() if line.startswith("# ")
                )
                command = "".join(
                    line + "\n" for line in block.splitlines() if not line.startswith("# ")
                )
                out = self.shell("set -e\n" + command)
                for line in expected.splitlines():
                    pattern = re.escape(line).replace("…", ".*").replace(r"\.\.\.", ".*")
                    self.assertRegex(out + self.err, pattern)

    def test_readme(self):
        self.run_document("README.md")

    def test_tutorial(self):
        self.run_document("doc/tutorial.md")

    def test_modules(self):
        self.run_document("doc/modules.md")


if __name__ == "__main__":
    BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
