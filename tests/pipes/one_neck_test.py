#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tasks that want the head at once: the unit obeys the one in focus alone."""

import math
import os
import re
import signal
import time
import unittest

from feeder import Feeder, Source
from graphs import Graphs
from harness import ROOT, wait_until

STEP = math.radians(185.1428 / 3600)  # of the unit [rad]
LEFT, RIGHT, POINT = 1, 2, 3  # modes
TILT = 0.2  # [rad] of what the task to the left looks at; to the right it is up, by stick 0
ENOUGH = 5  # commands of a task that reach the unit before something changes

GRAPH = """
[graphs.head]
file = "HEAD"
modules.eyes.parameters = { rate = 0.1, width = 80, height = 60 }

[modes]
left = 1
right = 2
point = 3

[workspace]
module = "workspace"

[modules.workspace]
parameters = { rate = 200, dwell = 0.05 }

[modules.left]
program = "gaze"
mode = "left"
parameters = { salience = 0.5, timeout = 60, acceleration = 0 }

[modules.right]
program = "gaze"
mode = "right"
parameters = { salience = 0.2, timeout = 60, acceleration = 0 }

[modules.point]
program = "gaze"
mode = "point"
parameters = { salience = 1, timeout = 0.3, acceleration = 0, tilt_min = 0, tilt_max = 0 }

[[modules.left.inputs.setpoint]]
from = "unix-listen:left"

[[modules.right.inputs.setpoint]]
from = "unix-listen:right"

[[modules.point.inputs.stick]]
from = "unix-listen:stick"

[[modules.workspace.inputs.bids]]
from = "left.bid"

[[modules.workspace.inputs.bids]]
from = "right.bid"

[[modules.workspace.inputs.person]]
from = "point.bid"

[[modules.workspace.outputs.focus]]
to = "file:focus"

[[graphs.head.modules.unit.outputs.received]]
to = "file:received"
"""

COMMAND_LINK = """
[[COMMANDS]]
from = "%s.command"
keep = "latest"
rate = 500
"""


def feeder(path, message):
    """`message` gives info, coord, width and the row, from the time [s]; nothing: silence."""
    source = Source(path)

    def say(now):
        if made := message(now):
            info, coord, width, row = made
            text = "1 1 0 0 8 %d %d 0 %d %d 1\n%s\n"
            source.send((text % (time.time_ns(), info, coord, width, row)).encode())

    return Feeder(say, 0.005)


def setpoint(side):
    """Looks to a side, down or up, and to and fro a little, so that each command is another."""

    def message(now):
        pan = side * (1 + 0.2 * math.sin(3 * now))
        return 20390, 13, 1, "0 %r %r" % (side * TILT, pan)

    return message


def owner_of(pan, tilt):
    """The mode of the task that has commanded that [position], 0 of none."""
    pan, tilt = pan * STEP, -tilt * STEP
    if abs(tilt) < STEP:
        return POINT
    side = 1 if tilt > 0 else -1
    is_whole = abs(tilt - side * TILT) < 0.05 and 0.6 < side * pan < 1.4
    return (LEFT if side > 0 else RIGHT) if is_whole else 0


class Mixed(AssertionError):
    """The unit was told what no task in focus has commanded."""


def told_in(stints, commands):
    """How many commands the unit was given in each stint of the focus.

    stints: (begin, mode); commands: (time, mode). Commands of a stint come behind its begin, and
    none of an older one behind those of a newer one. When a stint's last command comes nothing
    says: it may be on its way while the focus changes.
    """
    counts, now = [0] * len(stints), 0
    for number, (at, mode) in enumerate(commands):
        fitting = [i for i, each in enumerate(stints) if each[1] == mode and each[0] <= at]
        if not fitting or fitting[-1] < now:
            around = [each[1] for each in commands[max(0, number - 5) : number + 5]]
            raise Mixed("command %d is of mode %d, among those of %s" % (number, mode, around))
        now = fitting[-1]
        counts[now] += 1
    return counts


class OneNeck(Graphs):
    def start_tasks(self, is_exclusive=True):
        head, more = ROOT / "graphs/simulated_head.toml", ""
        commands = "graphs.head.modules.neck.inputs.command"
        if not is_exclusive:
            text = head.read_text()
            self.assertEqual(text.count('exclusive = ["command"]\n'), 1)
            self.write("head.toml", text.replace('exclusive = ["command"]\n', ""))
            # A neck that takes all has one sender, or the graph would be refused.
            head, commands = "head.toml", "modules.relay.inputs.in"
            more = '[modules.relay]\n[graphs.head.modules.neck]\ninputs.command = "relay.out"\n'
        links = "".join(COMMAND_LINK % task for task in ("left", "right", "point"))
        self.write_graph(
            (GRAPH + links).replace("HEAD", str(head)).replace("COMMANDS", commands) + more
        )
        self.process = self.start("exec hc run g.toml 2>said")
        self.stick = 0.0
        pushed = lambda now: (120190, 0, 2, "%g 0" % self.stick) if self.stick else None
        self.feeders = [
            feeder(self.path("left"), setpoint(1)),
            feeder(self.path("right"), setpoint(-1)),
            feeder(self.path("stick"), pushed),
        ]
        self.addCleanup(lambda: [feeder.end() for feeder in self.feeders])
        self.wait_told(LEFT)

    def said(self):
        return self.read("said")

    def stints(self):
        changes = [(0, 0)]
        for each in self.recorded("focus"):
            if (mode := int(each.rows[0][0])) != changes[-1][1]:
                changes.append((each.time, mode))
        return changes

    def commands(self):
        """When and by whom the unit was told where to go."""
        words, rest = [], ""
        for each in self.recorded("received"):
            *whole, rest = re.split(r"(?<= )", rest + each.rows[0])
            words += [(each.time, word.strip()) for word in whole]
        found, pan = [], None
        for at, word in words:
            if command := re.fullmatch(r"([pt]p)(-?\d+)", word):
                if command[1] == "pp":
                    self.assertIsNone(pan, "twice pan, without tilt")
                    pan = int(command[2])
                else:
                    found.append((at, owner_of(pan, int(command[2]))))
                    pan = None
            elif word == "h":
                pan = None
        return found

    def wait_told(self, mode):
        """Waits until a task that has the focus has given the unit enough commands from now on."""
        known = len(self.commands())

        def is_enough():
            begin, focus = self.stints()[-1]
            since = [owner for at, owner in self.commands()[known:] if at >= begin]
            return focus == mode and since.count(mode) >= ENOUGH

        try:
            wait_until(is_enough)
        except AssertionError:
            self.fail((mode, self.stints()[-3:], self.commands()[-9:], self.said()[-3000:]))

    def set_saliences(self, left, right):
        sets = ["set left.salience=%g" % left, "set right.salience=%g" % right]
        self.assertEqual(self.ask(self.process, *sets), ["ok"])

    def send_signal(self, name, number):
        messages = self.observe(self.process)
        state = self.state(messages, lambda state: self.module(state, name)["pid"])
        os.kill(self.module(state, name)["pid"], number)

    def kill(self, name):
        starts = self.said().count(name + ": started")
        self.send_signal(name, signal.SIGKILL)
        wait_until(lambda: self.said().count(name + ": started") > starts)

    def finish(self):
        self.stop(self.process)
        return told_in(self.stints(), self.commands())

    def test_the_unit_is_told_nothing_but_by_the_task_in_focus(self):
        self.start_tasks()
        for change in range(4):
            self.set_saliences(0.2, 0.5 + 0.1 * change)
            self.wait_told(RIGHT)
            self.set_saliences(0.9 - 0.1 * change, 0.1)
            self.wait_told(LEFT)
        for push in (1, -1, 0.3):  # a person cuts in, and the head is given back
            self.stick = push
            self.wait_told(POINT)
            self.stick = 0.0
            self.wait_told(LEFT)
        self.set_saliences(0.6, 0.3)
        self.kill("left")  # and is back before its bid has expired
        self.wait_told(LEFT)
        for number in (signal.SIGCONT, signal.SIGKILL, signal.SIGCONT):
            self.send_signal("left", signal.SIGSTOP)
            self.wait_told(RIGHT)
            self.send_signal("left", number)
            self.wait_told(LEFT)
        self.stick = 1.0
        self.wait_told(POINT)
        self.kill("point")
        self.stick = 0.0
        self.wait_told(LEFT)
        self.kill("head_neck")
        self.wait_told(LEFT)
        self.set_saliences(0.1, 0.9)
        self.wait_told(RIGHT)
        counts = self.finish()
        self.assertGreaterEqual(sum(count >= ENOUGH for count in counts), 24, counts)

    def test_a_neck_that_takes_all_is_told_by_all(self):
        """What the test above looks for would be found."""
        self.start_tasks(is_exclusive=False)
        self.set_saliences(0.2, 0.5)
        self.wait_told(RIGHT)
        with self.assertRaises(Mixed):
            self.finish()


if __name__ == "__main__":
    unittest.main()
