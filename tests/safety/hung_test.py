#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Modules of the head that hang."""

import contextlib
import os
import signal
import time
import tomllib
import unittest

from table import Safety  # which knows the way to the others
from head import HEAD, IS_FULL
from driver import seat_bid, seat_stick
from harness import wait_until
from streams import message, rotation, run_delay
from web_socket import BINARY

HUNG = 60 if IS_FULL else 0  # at least, before the stop [s]
SLOW = 6  # a queue that takes longer to fill is not waited for [s]
OLD = 0.5  # how old the state of the graph may be [s]
RING = 2048  # messages that a queue without a number holds
# After which an output that sends nothing is silent: before `hc run` restarts the module that hangs,
# or the page closes a connection that answers no ping [s].
WAITS = 5
SOON = 10  # after which `hc run` restarts a module of the head, where the file says no other [s]
LATE = 0.2  # the last command after a stop, not counting waits for a processor [s]
MORE = 2100  # messages than a queue holds
WAY = ("web", "workspace", "head_neck", "head_unit")  # of whatever a person drives by
DRIVES = (
    ("point", "pushing"),
    ("telepresence", "turning"),
)  # tasks, and how a person drives by them


class Hung(Safety):
    begin = {**Safety.begin, "head_eyes.rate": 20}  # with which queues are soon full

    def flows(self, seconds):
        """How many messages each output sends in such a time."""
        before = self.head.sent()
        time.sleep(seconds)  # how many in this time is the question
        after = self.head.sent()
        return {output: after.get(output, 0) - count for output, count in before.items()}

    def steady(self):
        """Bids and the focus, where they are always sent."""
        state = self.head.state_now()
        ends = {
            link["from"] for link in state["links"] if link["to"].split(".")[0] in state["focus"]
        }
        rates = [self.flows(1) for _ in range(3)]
        return {
            output
            for output in ends | {"workspace.focus"}
            if min(each.get(output, 0) for each in rates) > 3
        }

    def drive(self, without=""):
        """Somebody drives by a task that does not need a module; whether there is one."""
        for task, way in DRIVES:
            if without not in self.needs[task] and without not in WAY:
                self.head.sit(getattr(self.head, way)())
                self.head.wait_moving()
                return True
        return False

    def fill_queues(self):
        """Sends more of all that a page can send than queues hold."""
        burst = (
            seat_stick(0),
            rotation(0, src=2, stamp=0),
            message(10390, "400 300 0", coord=7, src=3, stamp=0),
            message(60100, "a", coord=30, src=4, stamp=0),
            seat_bid(1, self.head.mode("point")),
        )
        for _ in range(MORE):
            for each in burst:
                self.head.seat.socket.send_frame(BINARY, each)

    def seconds_to_fill(self, name):
        """How long the other modules take to fill the queues of a module, without slow queues."""
        seconds = [
            OLD + (int(link["keep"]) if link["keep"].isdigit() else RING) / link["per_second"]
            for link in self.head.state_now()["links"]
            if link["to"].split(".")[0] == name and link["per_second"]
        ]
        return max((each for each in seconds if each < SLOW), default=0)

    def note_lost(self, name, is_driven, filled):
        """Which modules wait for one that hangs, or have stopped sending, and do not need it: once
        its queues are full."""
        time.sleep(filled)
        # The page's server sends what a person wants.
        others = {each for each, needed in self.needs.items() if name not in needed}
        others -= set() if is_driven else {"web"}
        begun, before = time.monotonic(), self.head.sent()
        silent = {each for each in self.outputs if each.split(".")[0] in others}
        most = max(1, WAITS - filled)
        while (passed := time.monotonic() - begun) < HUNG - filled or silent and passed < most:
            after = self.head.sent()
            silent = {each for each in silent if after.get(each, 0) == before.get(each, 0)}
        lost = {output.split(".")[0] for output in silent}
        lost |= others & {
            each["name"]
            for each in self.head.state_now()["modules"]
            if each["detail"].startswith("blocked")
        }
        self.note("lost", len(lost), "%s %s" % (name, sorted(lost)))

    def stop_beside(self, name):
        head, is_driven = self.head, self.drive(name)
        filled = self.seconds_to_fill(name)
        with contextlib.ExitStack() as waiting:
            with head.hung(name):
                if is_driven:
                    self.fill_queues()
                    head.sit(head.seat.says)
                self.note_lost(name, is_driven, filled)
                if is_driven:  # the clicks in the queues hold the head for 2 s
                    head.wait_moving()
                waits = waiting.enter_context(head.waits())
                stopped = head.press_stop()
                if name == "head_unit":  # it says nothing, and moves on when it returns
                    head.send_signal(name, signal.SIGCONT)
                    stopped = time.time_ns()
                self.note_halt(stopped, waits, name)
            wait_until(head.is_whole)
            head.motion.rests_at(time.time_ns())  # with what the module has sent since
            counted = stopped + 10**9  # until then waits are excused
            after = [
                (at - stopped) / 1e9 - waits.until(min(at, counted))
                for at in head.line.positions(stopped)
            ]
        late = ["%.3f s" % each for each in after if each > LATE]
        self.note("commanded", len(late), "%s, after the stop: %s" % (name, late))

    def test_stop_beside_a_hung_module(self):
        head = self.head
        head.tell("set workspace.rate=1000")
        self.needs = head.needs()
        self.drive()
        self.outputs = self.steady()
        for name in self.chosen():
            head.settle()
            before = head.restarts(but=[name])
            self.stop_beside(name)
            self.note_ended(before, but=[name], where=name)
        head.tell("set workspace.rate=200")
        self.hold()

    def chosen(self):
        """All modules, or those of HC_MODULES; each second one, from HC_HALF on, 0 or 1."""
        names = os.environ.get("HC_MODULES", "").split() or self.head.names()
        return names[int(os.environ["HC_HALF"]) :: 2] if "HC_HALF" in os.environ else names

    def test_driving_through_a_hung_module(self):
        for name in ("web", "point", "workspace", "head_neck"):
            self.head.settle()
            self.head.drive()
            with self.head.waits() as waits, self.head.hung(name) as moment:
                self.note_halt(moment, waits, name)
        self.hold()

    def test_a_module_hangs_for_good(self):
        """Those whose work takes long are left out where the test is short."""
        given = tomllib.loads(HEAD.read_text())["modules"]
        hang = {name: given.get(name, {}).get("hang", SOON) for name in self.head.names()}
        hang = {name: seconds for name, seconds in hang.items() if IS_FULL or seconds == SOON}
        before = {name: self.head.pid(name) for name in hang}
        had_waited = run_delay(self.head.process.pid)
        begun, back = time.monotonic(), {}
        for pid in before.values():
            os.kill(pid, signal.SIGSTOP)

        def are_anew():
            for each in self.head.state_now()["modules"]:
                name = each["name"]
                is_new = each["status"] == "running" and each["pid"] not in (0, before.get(name))
                if is_new and name in hang and name not in back:
                    took = time.monotonic() - begun - hang[name]
                    back[name] = took, self.head.restart_waited(name, had_waited)
            return before.keys() <= back.keys()

        try:
            wait_until(are_anew)
            (took, waited), started = max(back.values()), self.head.start_took
            where = "beside others who had the processor for %.3f s" % waited
            self.note("back", took / started, where, waited / started)
            self.hold()
        finally:
            for pid in before.values():
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGCONT)


if __name__ == "__main__":
    unittest.main()
