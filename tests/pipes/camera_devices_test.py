#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The module camera with GigE Vision cameras: Aravis' fake ones, in a network of the test's own."""

import json
import os
import re
import shutil
import signal
import subprocess
import time
import unittest

from namespaces import move_to_own_network

FAKE = shutil.which("arv-fake-gv-camera-0.8")

# Such a camera has a port of its address that cannot be chosen; and a second address is wanted.
OWN = move_to_own_network("ip link set lo up && ip addr add 127.0.0.2/8 dev lo")

# It takes an argument away.
from harness import Pipes, WATCHDOG, wait_until  # noqa: E402

CHANGE = re.compile(
    r"camera: (?:warning: )?aravis:127\.0\.0\.(\d): (?:(disconnected): .*; reconnecting|(reconnected))"
)


@unittest.skipUnless(FAKE, "arv-fake-gv-camera-0.8 (package aravis-tools) is not there")
class CameraDevices(Pipes):
    def fake(self, number):
        """Starts a fake camera at 127.0.0.NUMBER, which answers when this returns."""
        address = "127.0.0.%d" % number
        if number > 1 and not OWN:
            self.skipTest("no network of one's own, and so no second camera")
        process = subprocess.Popen(
            [FAKE, "-i", address, "-s", "GV0%d" % number], stdout=-3, stderr=-3
        )
        self.addCleanup(self.kill, process)
        wanted = " %02X0000%02X:0F74 " % (number, 0x7F)  # the port of GigE Vision's control, 3956

        def listens():
            self.assertIsNone(process.poll(), "the fake camera does not run")
            with open("/proc/net/udp", encoding="ascii") as table:
                return wanted in table.read()

        wait_until(listens)
        return process

    @staticmethod
    def kill(process):
        if process.poll() is None:
            process.send_signal(signal.SIGKILL)
        process.wait()

    def camera(self, arguments):
        """Starts hc camera, with its images as text in `seen` and its lines in `said`."""
        return self.start("hc camera %s --width 8 --height 8 2>said | hc cat >seen" % arguments)

    def said(self):
        """All lines that are whole."""
        return self.read("said").split("\n")[:-1]

    def changes(self, number=1):
        """What was said of a camera that came and went. There may be more of it than a test has
        done: a fake one that has to wait for its processor is silent, too."""
        found = map(CHANGE.fullmatch, self.said())
        changes = [each[2] or each[3] for each in found if each and each[1] == str(number)]
        self.assertTrue(all(a != b for a, b in zip(changes, changes[1:])), self.said())
        return changes

    def others(self):
        """What was said besides."""
        return [line for line in self.said() if not CHANGE.fullmatch(line)]

    def wait_change(self, change, number=1):
        wait_until(lambda: self.changes(number)[-1:] == [change])

    def seen(self, word="rgb_image"):
        return self.read("seen").count(word)

    def test_images_of_a_camera_with_its_time(self):
        self.fake(1)
        before = time.time_ns()
        out = self.shell(
            "hc camera aravis:127.0.0.1 --count 3 --width 16 --height 16 | hc cat --json"
        )
        images = [json.loads(line) for line in out.splitlines()]
        times = [image["time"] for image in images]
        self.assertEqual(len(times), 3)
        self.assertEqual(times, sorted(set(times)))
        self.assertTrue(before < times[0] <= times[-1] < time.time_ns())
        self.assertEqual((images[0]["coord"], images[0]["width"]), (7, 16))

    def test_pixel_formats(self):
        self.fake(1)
        for pixels in ("Mono8", "RGB8", "BayerRG8"):
            command = "hc camera aravis:127.0.0.1 --pixel_format %s --count 2 | hc info" % pixels
            self.assertRegex(self.shell(command), r"rgb_image \d+ x \d+ of 3 x u8", pixels)
        command = "hc camera aravis:127.0.0.1 --pixel_format Nonsense --reopen=false"
        self.shell(command, status=1)
        self.assertEqual(len(self.err.splitlines()), 1, self.err)

    @unittest.skipUnless(OWN, "no network of one's own: other cameras may be the first")
    def test_the_first_camera(self):
        self.fake(1)
        self.assertIn("rgb_image", self.shell("hc camera aravis: --count 2 | hc info"))

    def test_exposure_and_gain_are_set_as_it_runs(self):
        self.fake(1)
        camera = self.start(
            "mkfifo commands; hc camera aravis:127.0.0.1 --exposure 0.01 --gain 1 --width 8"
            " --height 8 --out - --control commands 2>said | hc cat >seen"
        )
        # What cannot be set is reported, and images continue.
        command = self.start("hc send --text 'set gain=9999' >commands")
        wait_until(self.others)
        self.assertRegex(self.others()[0], "^camera: warning: aravis:127.0.0.1: gain must be from ")
        count = self.seen()
        wait_until(lambda: self.seen() > count)
        self.assertIsNone(camera.poll())
        command.communicate(timeout=WATCHDOG)

    def test_a_camera_that_is_killed_and_started_again(self):
        fake = self.fake(1)
        camera = self.camera("aravis:127.0.0.1")
        wait_until(lambda: os.path.exists(self.path("seen")) and self.seen() > 3)
        self.kill(fake)
        self.wait_change("disconnected")
        self.assertIsNone(camera.poll())
        self.fake(1)
        self.wait_change("reconnected")
        count = self.seen()
        wait_until(lambda: self.seen() > count)
        self.assertEqual(self.others(), [])

    def test_a_camera_that_hangs_and_continues(self):
        fake = self.fake(1)
        camera = self.camera("aravis:127.0.0.1")
        wait_until(lambda: os.path.exists(self.path("seen")) and self.seen() > 3)
        for _ in range(2):
            fake.send_signal(signal.SIGSTOP)
            self.wait_change("disconnected")
            fake.send_signal(signal.SIGCONT)
            self.wait_change("reconnected")
            count = self.seen()
            wait_until(lambda: self.seen() > count)
        self.assertIsNone(camera.poll())
        self.assertEqual(self.others(), [])

    def test_a_camera_that_comes_later(self):
        self.camera("aravis:127.0.0.1")
        wait_until(self.said)
        self.assertRegex(
            self.said()[0], "^camera: warning: aravis:127.0.0.1: cannot connect: .*; retrying$"
        )
        self.fake(1)
        wait_until(lambda: self.seen() > 0)
        self.assertEqual(self.said()[1], "camera: aravis:127.0.0.1: reconnected")
        self.assertEqual(len(self.others()), 1)

    def test_without_reopen_it_is_a_failure(self):
        self.shell("hc camera aravis:127.0.0.1 --reopen=false", status=1)
        self.assertRegex(self.err, "^camera: aravis:127.0.0.1: .*\n$")

    def taken(self, side):
        """When the images so far of one camera of a pair were taken, 1 or 2."""
        return re.findall(r"src %d seq \d+ in \S+ at (\S+ \S+)\n" % side, self.read("seen"))

    def pairs(self):
        return len(set(self.taken(1)) & set(self.taken(2)))

    def test_a_pair_has_one_time_and_when_one_is_lost_the_other_continues(self):
        self.fake(1)
        second = self.fake(2)
        self.camera("aravis:127.0.0.1 aravis:127.0.0.2")
        wait_until(lambda: self.pairs() > 20)
        self.kill(second)
        self.wait_change("disconnected", 2)
        rights, lefts = self.seen("src 2"), self.seen("src 1")
        wait_until(lambda: self.seen("src 1") > lefts + 5)
        self.fake(2)
        wait_until(lambda: self.seen("src 2") > rights + 1)
        self.wait_change("reconnected", 2)

        count = self.pairs()
        self.assertGreater(count, 0)
        wait_until(lambda: self.pairs() > count)  # and they are taken together again
        rights = self.taken(2)
        self.assertEqual(len(rights), len(set(rights)))  # each is in one pair at most


if __name__ == "__main__":
    unittest.main()
