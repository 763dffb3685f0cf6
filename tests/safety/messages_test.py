#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Messages into the head that are bad, old, of the future, or not of the mode in focus."""

import json
import random
import time
import unittest

from bad_messages import CLOSES, bad_messages
from table import Safety  # which knows the way to the others
from feeder import Feeder
from harness import if_quick
from streams import bid, message, rotation, stick

EACH = 50  # of each of 20 kinds
TILT = 0.3  # of these commands, and nobody else's [rad]
HOUR = 3600 * 10**9  # [ns]


class BadMessages(Safety):
    # Its own images are as large as bad ones, since memory is measured.
    begin = {"is_calibrated": False, "head_eyes.rate": 5, "calibrate.salience": 0}

    def inputs(self):
        """All inputs that have links, and their types."""
        head, types = self.head, {}
        ends = sorted({link["to"] for link in head.state_now()["links"]})
        for name in head.names():
            answer = head.ask(head.process, "describe " + name, name="head")
            for port in json.loads(answer[1])["inputs"]:
                types["%s.%s" % (name, port["name"])] = port["types"]
        return [(end, types.get(end, [])) for end in ends if ":" not in end]

    def flood(self, end, types):
        """Sends 1,000 bad messages into an input, and waits until all have come."""
        source, bad = self.head.source(end), bad_messages(types, self.head.mode("point"))
        for _ in range(EACH):
            for kind, data in bad.items():
                self.head.wait(lambda: source.send(data), "%s listens, beside %s" % (end, kind))
                if kind in CLOSES:
                    source.end()
        source.end()

    def memory(self):
        return {each["name"]: each["memory"] for each in self.head.state_now()["modules"]}

    def gained(self, name, before):
        """The memory that a module has gained and keeps [MB]: it is measured once in a while, maybe
        while the module held one of the large messages."""
        most = self.row.limits["memory"]["most"]
        gain = lambda: round((self.memory()[name] - before[name]) / 1e6, 1)
        self.head.wait(lambda: gain() <= most, "%s gives back all but %s MB" % (name, most))
        return gain()

    @if_quick
    def test_bad_messages(self):
        head = self.head
        head.quiet()
        # Until then modules gain the memory that they work in.
        head.wait(lambda: head.sent()["augment.left"] > 10, "images have come through all modules")
        for end, types in self.inputs():
            name = end.split(".")[0]
            ended, memory, begun = head.restarts(), self.memory(), time.time_ns()
            self.flood(end, types)
            # It works again, too: no message keeps it busy.
            runs = lambda: head.module(head.state_now(), name)["status"] == "running"
            head.wait(lambda: head.is_whole() and runs(), "all run after bad messages into " + end)
            self.note_ended(ended, where=end)
            self.note("memory", self.gained(name, memory), end)
            where = "%s, focus %s" % (end, head.focused.changes(begun))
            self.note("commanded", len(head.line.positions(begun)), where)
        self.hold()


class Times(Safety):
    def steering(self, stamp):
        """What would move the head, of a time [ns]: into which input, and what."""
        return (
            ("point.stick", stick(1, stamp=stamp)),
            ("point.target", message(10390, "100 100 0", coord=7, stamp=stamp)),
            ("telepresence.setpoint", rotation(0.4, stamp=stamp)),
            ("workspace.person", bid(1, self.head.mode("point"), stamp=stamp)),
        )

    def command(self, stamp):
        """The same, of the task in focus."""
        sent = rotation(0.4, coord=13, mode=self.head.mode("point"), stamp=stamp)
        return (("head_neck.command", sent),)

    def note_motion(self, messages):
        """While messages come, of the past and of the future."""
        head, now = self.head, time.time_ns()
        for what, stamp in (("1 h ago", now - HOUR), ("in 1 h", now + HOUR), ("1970", 10**9)):
            begun, sent = time.time_ns(), messages(stamp)
            for _ in range(50):
                for port, data in sent:
                    head.source(port).insist(data)
                time.sleep(0.01)  # as often as they are sent
            head.motion.rests_at(time.time_ns(), 0.2)
            where = "%s %s" % (" ".join(port for port, _ in sent), what)
            self.note("travelled", head.motion.travelled(begun), where)

    def test_old_and_future_messages(self):
        head = self.head
        head.quiet()
        self.note_motion(self.steering)
        # A person chooses a task and sends no stick: a command is refused for its time alone.
        mode, person = head.mode("point"), head.source("workspace.person", 1)
        feeder = Feeder(lambda _: person.send(bid(1, mode)), 0.1)
        self.addCleanup(feeder.end)
        head.wait_focus("point")
        self.note_motion(self.command)
        self.hold()

    def test_commands_without_the_focus(self):
        head, chosen = self.head, random.Random(1)
        head.quiet()
        modes = list(head.state_now()["modes"].values())
        for focus in (None, "point", "telepresence"):
            if focus:
                head.sit({"point": head.pushing, "telepresence": head.turning}[focus]())
                head.wait_moving()
            others = [m for m in modes + [0, 99] if not focus or m != head.mode(focus)]
            begun = time.time_ns()
            for number in range(2000):
                sent = rotation(0.2, TILT, 13, chosen.choice(others), chosen.choice((1, 90, 91)))
                head.source("head_neck.command", number % 3).insist(sent)
            head.motion.wait_more(40)
            self.note("commanded", len(head.line.tilts(begun, TILT)), focus or "nobody")
        self.hold()


if __name__ == "__main__":
    unittest.main()
