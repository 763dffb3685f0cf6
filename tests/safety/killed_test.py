#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Modules of the head that are killed."""

import os
import signal
import time
import unittest

from table import Safety  # which knows the way to the others
from streams import run_delay


class Killed(Safety):
    def missing(self, name, pid, before):
        """What of a module and of outputs is not there yet, since so many messages."""
        module = self.head.module(self.head.state_now(), name)
        if module["status"] != "running" or module["pid"] in (0, pid):
            return [name]
        sent = self.head.sent()
        return [output for output, count in before.items() if sent.get(output, 0) <= count]

    def yields(self, name):
        return os.getpriority(os.PRIO_PROCESS, self.head.pid(name)) > 0

    def is_back(self, name, pid, before):
        """Waits until a module runs anew, and outputs have sent more than so many messages."""
        self.left = [name]

        def is_there():
            self.left = self.missing(name, pid, before)
            return not self.left

        self.head.wait(is_there, "%s is back, of %s" % (name, sorted(before)))

    def test_a_module_is_killed(self):
        head = self.head
        # Outputs that send whatever is seen.
        steady = (".bid", ".left", ".focus", ".motion", ".pose")
        outputs = [end for end in head.sent() if end.endswith(steady) and end != "web.bid"]
        # What yields the processor to the others comes when they leave it some.
        late = [each for each in outputs if self.yields(each.split(".")[0])]
        self.assertLess(len(late), len(outputs) / 2)
        for name in head.names():
            before, begun = head.restarts(but=[name]), time.monotonic()
            said = len(head.said())
            waited = run_delay(head.process.pid)
            pid = head.send_signal(name, signal.SIGKILL)
            # What a new process has sent is counted from 0 on.
            own = {each: 0 for each in outputs if each.startswith(name + ".")}
            self.is_back(name, pid, {each: 0 for each in own if each not in late})
            sent = {**head.sent(), **own}
            self.is_back(name, pid, {each: sent[each] for each in outputs if each not in late})
            took = time.monotonic() - begun
            waited = head.restart_waited(name, waited)
            where = "%s, beside others who had the processor for %.3f s: %s"
            self.note("back", took, where % (name, waited, head.said()[said:]), waited)
            self.is_back(name, pid, {each: sent[each] for each in late})
            self.note_ended(before, but=[name], where=name)
        self.hold()

    def test_the_neck_is_killed_while_it_moves(self):
        head = self.head
        head.drive()
        pid = head.pid("head_neck")
        with head.waits() as waits:
            moment = time.time_ns()
            os.kill(pid, signal.SIGKILL)
            head.leave()  # else it moves again once it is back
            self.note_halt(moment, waits)
        head.wait(head.is_whole, "all run")
        head.drive()
        self.hold()

    def test_a_stop_outlives_those_who_keep_it(self):
        head = self.head
        head.drive()
        assert head.page.ask("estop") == "ok"
        head.motion.rests_at(time.time_ns())
        stopped = time.time_ns()
        for together in (["web", "workspace"], ["workspace"], ["web"], ["workspace", "web"]):
            for name in together:
                head.send_signal(name, signal.SIGKILL)
            head.wait(head.is_whole, "all run")
            head.open_page()
            head.wait(lambda: head.page.session["stopped"], "the page says that it is stopped")
            head.sit(head.pushing())
            head.motion.rests_at(time.time_ns(), 1)  # while one pushes, and tasks bid
            self.note("travelled", head.motion.travelled(stopped), " and ".join(together))
        self.hold()


if __name__ == "__main__":
    unittest.main()
