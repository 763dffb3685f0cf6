#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Scripts that take messages in a loop."""

import pathlib
import unittest

from package import Package, hc


class Pulled(Package):
    SCRIPT = """
import hypercolumn as hc
module = hc.Module("pulled", "Takes messages in a loop.")
left = module.input("left", hc.table(), "numbers")
right = module.input("right", hc.table(), "numbers")
out = module.output("out", hc.table(), "sums")
%s"""

    def numbers(self, name, count, first=0, stride=1):
        """A file of numbers, one a message."""
        lines = [
            "1 1 0 %d 8 %d 120190 0 0 1 1\n%d\n" % (i, i + 1, first + i * stride)
            for i in range(count)
        ]
        self.write(name, "".join(lines))
        return self.path(name)

    def pull(self, body, status=0, count=3, arguments=""):
        """The numbers that a script sends, which is given 0, 1, 2, … and 0, 10, 20, …"""
        program = self.write_module("module", self.SCRIPT % body)
        left, right = self.numbers("left", count), self.numbers("right", count, stride=10)
        words = " --in left=%s --in right=%s --out out=file:out.mtp " % (left, right)
        out = pathlib.Path(self.path("out.mtp"))
        out.unlink(missing_ok=True)
        self.shell(program + words + arguments, status)
        if status != 0:
            return []
        with hc.open(str(out)) as stream:
            return [(message.time, message.numbers[0]) for message in stream]

    def test_a_loop_takes_the_messages_of_an_input(self):
        body = "for message in left: out.send(message.numbers[0] + 1)"
        self.assertEqual(self.pull(body), [(1, 1), (2, 2), (3, 3)])

    def test_two_inputs_are_taken_in_step_or_one_after_the_other(self):
        body = "for a, b in zip(left, right): out.send(a.numbers[0] + b.numbers[0])"
        self.assertEqual([number for _, number in self.pull(body)], [0, 11, 22])
        body = "out.send(sum(m.numbers[0] for each in (right, left) for m in each))"
        self.assertEqual([number for _, number in self.pull(body)], [33])

    def test_it_may_send_after_its_loop_and_stop_before_the_end(self):
        body = "for message in left:\n    if message.numbers[0] == 1: module.stop()\n"
        self.assertEqual(self.pull(body + "out.send(7, time=9)"), [(9, 7)])
        self.assertEqual(self.pull("for message in left: break\nout.send(7, time=9)"), [(9, 7)])

    def test_handlers_and_timers_work_meanwhile(self):
        body = """
held = []
module.on(right)(lambda message: held.append(message.numbers[0]))
for message in left: pass
out.send(sum(held), time=1)
"""
        self.assertEqual(self.pull(body, arguments="--clock messages"), [(1, 30)])

    def test_by_the_clock_of_the_messages_it_does_the_same(self):
        body = "for a, b in zip(left, right): out.send(a.numbers[0] + b.numbers[0])"
        self.assertEqual(len(self.pull(body, count=40, arguments="--clock messages")), 40)

    def test_what_is_wrong_ends_it_with_a_status(self):
        self.pull("for message in left: raise ValueError('no')", 1)
        self.assertIn("ValueError: no", self.err)
        # Bad messages in a file, known at its end: the script goes on, and its status says so.
        self.write("bad", "1 1 0 0 8 1 60100 0 0 1 1\n1\n")
        program = self.write_module(
            "module", self.SCRIPT % "for message in left: pass\nprint('on')"
        )
        self.shell("%s --in left=%s" % (program, self.path("bad")), 1)
        self.assertIn("\non\n", "\n" + self.err)
        self.shell("%s --nosuch" % program, 2)
        self.assertNotIn("Traceback", self.err)
        self.assertIn("Takes messages in a loop.", self.shell(program + " --help"))

    def test_a_handler_and_a_loop_for_one_input_are_refused(self):
        self.pull("module.on(left)(print)\nfor message in left: pass", 1)
        self.assertIn("input left has a handler", self.err)
        self.pull("for message in left: module.run()", 1)
        self.assertIn("already running", self.err)

    def test_it_ends_when_its_last_reader_has_left(self):
        program = self.write_module(
            "module", self.SCRIPT % "for message in left:\n    for i in range(10**6): out.send(i)"
        )
        self.shell("%s --in left=%s | head -c 100" % (program, self.numbers("left", 3)))
        self.assertEqual(self.err, "")

    def test_a_handler_takes_no_loop(self):
        body = """
@module.on(right)
def other(_):
    for message in left: pass
for message in left: pass
"""
        self.pull(body, 2)
        self.assertIn("a handler cannot take messages in a loop", self.err)

    def test_a_handler_that_comes_late_is_called(self):
        body = """
it = iter(left)
module.on(right)(lambda message: out.send(message.numbers[0]))
for message in it: pass
"""
        self.assertEqual([number for _, number in self.pull(body)], [0, 10, 20])

    def test_two_links_are_read_in_turn(self):
        one, two = self.numbers("left", 3), self.numbers("right", 3, first=100)
        program = self.write_module(
            "module", self.SCRIPT % "print(*(int(m.numbers[0]) for m in left))"
        )
        self.shell("%s --in left=%s --in left=%s" % (program, one, two))
        self.assertEqual(self.err, "0 100 1 101 2 102\n")

    def test_what_it_writes_elsewhere_is_kept_when_it_fails_at_its_end(self):
        self.write("bad", "1 1 0 0 8 1 60100 0 0 1 1\n1\n")
        body = "open_file = open('log', 'w')\nfor message in left: pass\nopen_file.write('all')"
        program = self.write_module("module", self.SCRIPT % body)
        self.shell("%s --in left=%s" % (program, self.path("bad")), 1)
        self.assertEqual(self.read("log"), "all")

    def test_its_end_is_not_called_after_an_exception(self):
        end = "module.on_end(lambda: print('end called'))\n"
        self.pull(end + "for message in left: pass\nout.send(1, time=1)")
        self.assertIn("end called", self.err)
        self.pull(end + "for message in left: raise ValueError('no')", 1)
        self.assertNotIn("end called", self.err)
        self.pull("import sys\nmodule.on_end(lambda: sys.exit(3))\nfor message in left: pass", 3)

    def test_a_thread_takes_no_loop(self):
        body = """
import threading
thread = threading.Thread(target=lambda: list(left))
thread.start()
thread.join()
"""
        program = self.write_module("module", self.SCRIPT % body)
        self.shell(program + " </dev/null")
        self.assertIn("only the main thread can take messages in a loop", self.err)

    def test_without_a_reader_it_exits(self):
        body = "for message in left: pass\nwhile True: out.send(1); module.keep_rate(1000)"
        program = self.write_module("module", self.SCRIPT % body)
        self.shell("%s --in left=%s | head -c 100" % (program, self.numbers("left", 3)))
        self.assertEqual(self.err, "")

    def test_of_those_that_share_standard_input_the_newest_wait(self):
        script = self.SCRIPT.replace('"right", hc.table()', '"right", hc.string()')
        body = "print(sum(1 for _ in left), *(m.text for m in right))"
        texts = "".join("1 1 0 %d 8 1 60100 0 0 1 1\n%d\n" % (i, i) for i in range(8))
        program = self.write_module("module", script % body)
        self.shell(program, data=(texts + "1 1 0 0 8 1 120190 0 0 1 1\n1\n").encode())
        self.assertIn("1 0 1 2 3 4 5 6 7\n", self.err)


if __name__ == "__main__":
    unittest.main()
