#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Inputs that are taken together: from one stream, files, FIFOs and shared memory."""

import os
import random
import re
import unittest

from harness import BUILD, WATCHDOG, Pipes

TRIO = BUILD / "tests/trio"
KINDS = {"place": ("10390", "1 2 3"), "score": ("120190", "5"), "words": ("60100", "x")}


def message(port, time, seq=0):
    info, elements = KINDS[port]
    return "1 9 0 %d 8 %d %s 0 0 1 1\n%s\n" % (seq, time, info, elements)


def stream(port, times):
    return "".join(message(port, time, seq) for seq, time in enumerate(times))


class Together(Pipes):
    def sets(self, command):
        lines = self.shell("%s | hc cat --raw" % command).splitlines()
        for header, elements in zip(lines[::2], lines[1::2]):
            self.assertEqual(int(header.split()[5]), max(map(int, elements.split())))  # R43
        return [tuple(map(int, line.split())) for line in lines[1::2]]

    def feed(self, **ports):
        """Writes a file for each port and gives the options that read them."""
        for port, times in ports.items():
            self.write(port, stream(port, times))
        return "".join(" --in %s=file:%s" % (port, port) for port in ports)

    def random_times(self, count):
        chance = random.Random(5)
        return {
            port: [1000 * i for i in range(1, count) if chance.random() < 0.9] for port in KINDS
        }

    def test_one_stream_and_three_files_give_the_same_sets(self):
        times = self.random_times(300)
        chance = random.Random(6)
        # Late by up to three messages, but those of an input stay in order.
        late = sorted(
            (time + chance.randint(0, 3000), port) for port in KINDS for time in times[port]
        )
        queues = {port: iter(times[port]) for port in KINDS}
        self.write("all", "".join(message(port, next(queues[port])) for _, port in late))
        sets = self.sets("%s < all" % TRIO)
        self.assertEqual(self.sets(str(TRIO) + self.feed(**times)), sets)
        wanted = sorted(set.intersection(*(set(times[port]) for port in KINDS)))
        self.assertEqual(sets, [(t, t, t) for t in wanted])
        self.assertGreater(len(wanted), 100)

    def test_fifos_and_shared_memory_give_the_same_sets(self):
        times = self.random_times(16)  # as many as may wait, since any writer may be the first
        sets = self.sets(str(TRIO) + self.feed(**times))
        self.assertGreater(len(sets), 5)
        fifos = " ".join("--in %s=<(cat %s)" % (port, port) for port in KINDS)
        self.assertEqual(self.sets("%s %s" % (TRIO, fifos)), sets)
        name = "shm:together-%d" % os.getpid()
        plays = " & ".join("hc play --speed max %s --out %s-%s" % (p, name, p) for p in KINDS)
        shared = " ".join("--in '%s=%s-%s?wait=60'" % (port, name, port) for port in KINDS)
        self.assertEqual(self.sets("{ %s & %s %s; }" % (plays, TRIO, shared)), sets)

    def test_the_end_of_one_input_ends_the_module(self):
        self.write("place", stream("place", [100]))
        self.write("words", stream("words", [100]))
        endless = "<(while printf '%s'; do :; done)" % message("score", 100).replace("\n", "\\n")
        ports = "--in place=file:place --in words=file:words --in score=%s" % endless
        self.assertEqual(self.sets("%s %s" % (TRIO, ports)), [(100, 100, 100)])

    def test_images_that_wait_leave_room_for_their_publisher(self):
        image = b"1 %d 0 0 8 %d 40101 0 %d 200 200\n" + bytes(40_000) + b"\n"
        self.write("left", b"".join(image % (1, time, 9) for time in range(1, 200)))
        right = b"".join(image % (2, time, 10) for time in range(150, 200))
        name = "shm:together-eyes-%d" % os.getpid()
        depth = self.start(
            "exec hc depth --disparities 16 --in 'left={0}-left?wait=60' "
            "--in 'right={0}-right?wait=60' --out disparity=file:found".format(name)
        )
        other = self.start("exec hc play --speed max - --out %s-right" % name, stdin=-1)
        self.shell("hc play --speed max left --out '%s-left?memory=2M'" % name)
        other.communicate(right, timeout=WATCHDOG)
        _, err = depth.communicate(timeout=WATCHDOG)
        self.assertEqual(depth.returncode, 0, err)
        found = self.read_bytes("found")
        count = len(re.findall(rb"1 1 0 \d+ 8 1\d\d 40181 0 12 200 200\n", found))
        said = re.search(rb"left: dropped (\d+) unmatched, (\d+) on queue overflow\n", err)
        self.assertEqual(int(said[1]) + int(said[2]) + count, 199)
        self.assertGreaterEqual(count, 16)


if __name__ == "__main__":
    unittest.main()
