#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Frames of a graph file: fixed ones and moving ones, at the times of messages."""

import math
import os
import pathlib
import time
import unittest

from harness import BUILD, Pipes, wait_until

START = 1763683200_000000000  # [ns]
STEP = 100_000_000  # [ns] between poses
TURN = 0.25  # [rad] of the head to the left in each
GRAPH = """version = 1
[modules.neck]
program = "relay"
addresses.out = 11
[modules.eyes]
program = "relay"
[modules.whereabouts]
program = "%s"
parameters = { %s }
[frames.robot]
parent = "world"
translation = [1.0, 2.0, 0.0]
rotation = [0.0, 0.0, 90.0]
[frames.head]
parent = "robot"
moved_by = "neck.out"
[frames.left_eye]
parent = "head"
translation = [0.05, 0.03, 0.0]
[[modules.neck.inputs.in]]
from = "file:poses"
[[modules.eyes.inputs.in]]
from = "file:images"
[[modules.whereabouts.inputs.when]]
from = "eyes.out"
[[modules.whereabouts.outputs.pose]]
to = "file:found"
keep = "all"
"""


def turned(yaw, x, y, z):
    """A turn to the left [rad] about z and a place [m], as rows."""
    c, s = math.cos(yaw), math.sin(yaw)
    return [[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, z], [0, 0, 0, 1]]


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def world_left_eye(steps):
    """T_world_left_eye, so many steps after the start: the head turns evenly and rises 1 cm each."""
    head = turned(TURN * steps, 0, 0, 0.3 + 0.01 * steps)
    return product(product(turned(math.pi / 2, 1, 2, 0), head), turned(0, 0.05, 0.03, 0))


def pose(step):
    rows = turned(TURN * step, 0, 0, 0.3 + 0.01 * step)
    text = "".join(" ".join(map(repr, row)) + "\n" for row in rows)
    return "1 11 0 %d 8 %d 70190 0 2003 4 4\n%s" % (step, START + STEP * step, text)


def image(number, time):
    return "1 12 0 %d 8 %d 60100 0 0 1 1\nx\n" % (number, time)


class Frames(Pipes):
    def run_graph(self, poses, times, parameters=""):
        """The poses that whereabouts prints, by time; `logged` is what the graph logs then."""
        self.write("graph.toml", GRAPH % (BUILD / "tests/whereabouts", parameters))
        self.write("poses", "".join(map(pose, poses)))
        self.write("images", "".join(image(*each) for each in enumerate(times)))
        pathlib.Path(self.path("found")).unlink(missing_ok=True)  # which would be kept
        self.shell("exec hc run graph.toml")
        self.logged = self.err
        return {each.time: each.rows for each in self.recorded("found")}

    def expect(self, rows, wanted):
        for row, wanted_row in zip(rows, wanted):
            for number, each in zip(row, wanted_row):
                self.assertAlmostEqual(number, each, delta=1e-12)  # m or 1, some roundings

    def test_the_left_eye_is_where_the_head_was_at_the_time_of_each_image(self):
        steps = [0, 0.5, 1.25, 3, 7.875, 9]
        times = [START + int(STEP * each) for each in steps]
        found = self.run_graph(range(10), times)
        self.assertEqual(sorted(found), times)
        for step, time in zip(steps, times):
            self.expect(found[time], world_left_eye(step))

    def expect_near(self, numbers, wanted):
        for number, each in zip(numbers, wanted):
            self.assertAlmostEqual(number, each, delta=1e-4)  # as printed

    def test_a_transform_is_printed_from_a_recording(self):
        self.write("graph.toml", GRAPH % (BUILD / "tests/whereabouts", ""))
        self.write("poses", "".join(map(pose, range(10))))
        self.write("images", image(1, START + STEP))
        self.shell("exec hc run graph.toml --record kept")
        at = START + int(1.25 * STEP)
        out = self.shell("hc frames graph.toml left_eye world --in kept --at %d" % at).splitlines()
        wanted = world_left_eye(1.25)
        self.assertEqual(out[0], "left_eye to world, at %d ns" % at)
        numbers = [[float(word) for word in line.split()[-3:]] for line in out[1:6]]
        self.expect_near(numbers[0], [row[3] for row in wanted[:3]])
        for row, wanted_row in zip(numbers[1:4], wanted):
            self.expect_near(row, wanted_row[:3])
        self.expect_near(numbers[4], [0, 0, 90 + math.degrees(1.25 * TURN)])
        self.assertEqual(out[6].split()[1:], "world -> robot -> head -> left_eye".split()[::-1])
        # The latest pose that is known, without a time.
        out = self.shell("hc frames graph.toml left_eye world --in kept")
        self.assertIn("left_eye to world, at %d ns\n" % (START + 9 * STEP), out)
        # A fixed one needs no recording.
        self.assertIn("robot to world, fixed\n", self.shell("hc frames graph.toml robot world"))
        self.shell("hc frames graph.toml left_eye word --in kept", status=1)
        self.assertIn('graph.toml: frames: no frame "word", did you mean', self.err)
        self.shell("hc frames graph.toml left_eye nose", status=1)
        self.assertIn('no frame "nose"; known: head, left_eye, robot, world', self.err)
        self.shell("hc frames graph.toml left_eye world --in kept --at %d" % (START - 1), status=1)
        self.assertIn("too early", self.err)

    def test_a_transform_is_printed_from_a_running_graph(self):
        self.write("graph.toml", GRAPH % (BUILD / "tests/whereabouts", ""))
        ends = []
        for name in ("poses", "images"):
            os.mkfifo(self.path(name))
            # Also a reader, so that opening it waits for nobody and it does not end.
            ends.append(os.fdopen(os.open(self.path(name), os.O_RDWR), "w"))
            self.addCleanup(ends[-1].close)
        name = "seen_%d" % os.getpid()
        self.shell("hc frames graph.toml left_eye world --of " + name, status=1)
        self.assertRegex(self.err, 'no graph "%s" is running.*; left_eye to world' % name)
        self.assertIn("depends on neck.out: run the graph", self.err)
        self.start("exec hc run graph.toml --as " + name)
        wait_until(lambda: name in self.shell("hc ps"))
        asked = self.start("exec hc frames graph.toml left_eye world --of " + name)
        step = 0
        while asked.poll() is None:  # until it has seen one
            ends[0].write(pose(step))
            ends[0].flush()
            step += 1
            time.sleep(0.01)
        out, err = asked.communicate()
        self.assertEqual(asked.returncode, 0, err)
        out = out.decode().splitlines()
        seen = (int(out[0].split()[4]) - START) // STEP
        self.assertIn(seen, range(step))
        numbers = [float(word) for word in out[1].split()[-3:]]
        self.expect_near(numbers, [row[3] for row in world_left_eye(seen)[:3]])


if __name__ == "__main__":
    unittest.main()
