#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Modules written in Python: how they describe themselves, what they send, how they work."""

import subprocess
import unittest


from package import ECHO, IN, Modules, hc

TWIN = """
import hypercolumn as hc
module = hc.Module("camera_like", "Has a bit of everything.")
image = module.input("image", hc.rgb_image(), "an image")
pose = module.input("pose", hc.any_of(hc.transformation(), hc.rotation().of(1, 1).in_("gaze")),
                    "where", actor=True, keep=3)
any = module.input("any", hc.anything(), "all")
mean = module.output("mean", hc.table().of(1, 3).in_(7), "numbers")
sound = module.output("sound", hc.sound(2).in_("sound_16k"), "noise")
module.parameter("loud", True, "", "a bool")
module.parameter("rate", 2.5, "Hz", "a number", min=0, max=100)
module.parameter("count", 8, "", "an integer", min=2, max=64, step=2)
module.parameter("name_of_it", "a", "", "a string", choices=["a", "b"], positional=True)
module.parameter("device", "/dev/null", "", "a fixed string", fixed=True)
module.run()
"""


class Declared(Modules):
    def test_it_describes_itself_as_in_cpp(self):
        self.maxDiff = None
        twin = self.shell("twin_in_cpp --describe")
        self.assertEqual(self.run_module(TWIN, "--describe"), twin)
        self.assertEqual(self.run_module(TWIN, "--help"), self.shell("twin_in_cpp --help"))
        wrong = "--rate 1000"
        self.shell("twin_in_cpp " + wrong, 2)
        said = self.err
        self.run_module(TWIN, wrong, status=2)
        self.assertEqual(self.err, said)

    def test_declarations_that_make_no_sense_are_errors(self):
        module = hc.Module("m", "a module")
        sender = module.output("sender", hc.table(), "numbers")
        for kind, text in (
            (lambda: hc.table(100), "1 … 99 components"),
            (lambda: hc.sound(1, "u8").in_("nowhere"), 'no coordinate system "nowhere"'),
            (lambda: hc.rotation(scalar="u8"), "R"),
            (lambda: hc.table(scalar="c16"), "not a scalar type of messages: complex128"),
            (lambda: module.output("o", hc.anything(), "all"), "an output has one kind"),
            (lambda: module.every(0)(print), "a period must be above 0 s"),
            (lambda: module.keep_rate(1), "keep_rate"),
            (lambda: sender.send(1), "send() may only be called in handlers of a running module"),
            (lambda: hc.together(module.input("x", hc.table(), "x")), "two inputs or more"),
        ):
            with self.subTest(text), self.assertRaises(hc.Error) as caught:
                kind()
            self.assertIn(text, str(caught.exception))
        port = module.input("i", hc.table(), "i")
        module.on(port)(print)
        with self.assertRaisesRegex(hc.Error, "two handlers"):
            module.on(port)(print)
        for scalar in ("f32", "f4", "float32"):
            self.assertEqual(repr(hc.table(scalar=scalar)), "<Kind table of 1 x f32>")

    def test_options_are_those_of_a_module(self):
        out = self.echo("table()", "out.send(message)", "--name x --address 9 --encoding binary")
        self.assertEqual(out.encode()[:33], b"1 9 0 0 8 55 120191 3 0 3 1\n" + bytes(5)[:5])
        self.echo("table()", "out.send(message)", "--no-such", status=2)
        self.assertEqual(len(self.err.splitlines()), 1)

    def test_the_command_finds_module_and_package(self):
        self.environment.pop("PYTHONPATH")
        program = self.write_module("module", ECHO % ("table()", "out.send(message)"))
        self.assertIn("[[1,2.5,-3]]", self.shell("hc %s | hc cat --json" % program, data=IN))


class Sent(Modules):
    def test_what_can_be_sent(self):
        head = "1 1 0 0 8 55 %s 3 %d %d %d\n"
        table, position, text = "120190", "10390", "60100"
        for kind, body, wanted in (
            ("table()", "out.send(message)", head % (table, 0, 3, 1) + "1 2.5 -3\n"),
            ("table()", "out.send(2 * message.matrix)", head % (table, 0, 3, 1) + "2 5 -6\n"),
            ("table()", "out.send(message.numbers)", head % (table, 0, 3, 1) + "1 2.5 -3\n"),
            ("table()", "out.send([1, True])", head % (table, 0, 2, 1) + "1 1\n"),
            ("table()", "out.send(message.matrix.T)", head % (table, 0, 1, 3) + "1\n2.5\n-3\n"),
            ("table()", "out.send(7)", head % (table, 0, 1, 1) + "7\n"),
            ("table()", "out.send(message.matrix.mean())", head % (table, 0, 1, 1) + "0.16666666666666666\n"),
            ("table()", "out.send([])", head % (table, 0, 0, 1) + "\n"),
            ("table()", "out.send([[1, 2], [3, 4]])", head % (table, 0, 2, 2) + "1 2\n3 4\n"),
            ("table().of(2, 2)", "out.send([1, 2, 3, 4])", head % (table, 0, 2, 2) + "1 2\n3 4\n"),
            ("table(scalar='f32')", "out.send(message.matrix)", head % ("120180", 0, 3, 1) + "1 2.5 -3\n"),
            ("table(scalar='i16')", "out.send([-5, 6])", head % ("120130", 0, 2, 1) + "-5 6\n"),
            ("position()", "out.send(message.matrix)", head % (position, 0, 1, 1) + "1 2.5 -3\n"),
            ("position()", "out.send([1, 2, 3, 4, 5, 6])", head % (position, 0, 2, 1) + "1 2 3 4 5 6\n"),
            ("position().in_('head')", "out.send((0, 0, 1))", head % (position, 3, 1, 1) + "0 0 1\n"),
            ("position()", "out.send((0, 0, 1), coord='gaze')", head % (position, 13, 1, 1) + "0 0 1\n"),
            ("string()", "out.send('müd')", head % (text, 0, 4, 1) + "müd\n"),
            ("string()", "out.send(b'ab')", head % (text, 0, 2, 1) + "ab\n"),
        ):  # fmt: skip
            with self.subTest(body=body, kind=kind):
                self.assertEqual(self.echo(kind, body), wanted)
        fields = self.echo("table()", "out.send(1, time=9, dst=4, mode=2)")
        self.assertEqual(fields, "1 1 4 0 8 9 120190 2 0 1 1\n1\n")

    def test_what_cannot_be_sent_is_said_in_a_line(self):
        for kind, body, text in (
            ("table(scalar='u8')", "out.send([256])", "R28: 256 does not fit into u8"),
            ("table(scalar='u8')", "out.send([-1])", "R28: -1 does not fit into u8"),
            ("table(scalar='u8')", "out.send([1 << 99])", "does not fit into u8"),
            ("table(scalar='u8')", "out.send(message.matrix)", "an array of float64, to be converted"),
            ("rgb_image()", "out.send(message.matrix[0, :2])", "an array of shape (2,)"),
            ("position()", "out.send([1, 2])", "2 numbers"),
            ("position()", "out.send(message)", "out: "),
            ("table().of(1, 2)", "out.send([1, 2, 3])", "3 numbers"),
            ("table()", "out.send('text')", "a text"),
            ("table()", "out.send(object())", "an array of object, to be converted"),
            ("table()", "out.loan(-1, 2)", "R"),
            ("table()", "out.send(1, coord='nowhere')", 'no coordinate system "nowhere"'),
        ):  # fmt: skip
            with self.subTest(body):
                self.echo(kind, body, status=1)
                lines = self.err.splitlines()
                self.assertEqual(len(lines), 1, self.err)
                self.assertIn(text, lines[0])
                self.assertTrue(lines[0].startswith("echo: "), lines)
                self.assertTrue(lines[0].endswith(" (module, line 10)"), lines)
        for body in ("out.send()", "out.send(1, 2)", "out.send(1, tme=2)"):
            with self.subTest(body):
                self.echo("table()", body, status=1)
                self.assertIn("Traceback", self.err)

    def test_a_list_that_changes_meanwhile_is_sent_as_it_was(self):
        body = """
    class Number:
        def __float__(self):
            numbers.clear()
            return 2.0
    numbers = [1.0, Number(), *map(float, range(3, 1000))]
    out.send(numbers)
"""
        out = self.echo("table()", body)
        self.assertEqual(out.splitlines()[1], " ".join(map(str, range(1, 1000))))

    def test_a_loan_is_sent_at_its_end_and_dropped_by_an_exception(self):
        body = """
    kept = []
    try:
        with out.loan(1, 2) as a:
            a[:] = 5
            raise KeyError()
    except KeyError:
        pass
    with out.loan(1, 2, time=7) as a:
        a[:] = 6
        kept.append(a)
    try:
        kept[0][0] = 1
    except ValueError:
        module.log("read-only")
    loan = out.loan(1, 1)
    with loan as a:
        a[:] = 8
    try:
        with loan:
            pass
    except hc.Error as error:
        module.log(error.code)
"""
        out = self.echo("table()", body)
        self.assertEqual(out, "1 1 0 0 8 7 120190 3 0 2 1\n6 6\n1 1 0 1 8 55 120190 3 0 1 1\n8\n")
        self.assertEqual(self.err, "echo: read-only\necho: Invalid\n")

    def test_a_port_with_a_shape_needs_none(self):
        out = self.echo("transformation()", "\n    with out.loan() as a:\n        a[:] = 0\n")
        self.assertEqual(out.splitlines()[0].split()[-2:], ["4", "4"])


class Loop(Modules):
    def test_messages_of_one_time_are_taken_together(self):
        text = """
import hypercolumn as hc
module = hc.Module("sum", "Adds.")
a = module.input("a", hc.table(), "a")
b = module.input("b", hc.table(), "b")
out = module.output("out", hc.table(), "sum")

@module.on(hc.together(a, b))
def add(one, other):
    out.send(one.matrix + other.matrix)

module.run()
"""
        message = b"1 %d 0 0 8 %d 120190 0 0 1 1\n%d\n"
        self.write("a", b"".join(message % (1, time, time) for time in (1, 2, 3)))
        self.write("b", b"".join(message % (2, time, 100) for time in (2, 3, 4)))
        out = self.run_module(text, "--in a=a --in b=b")
        self.assertEqual(out, "1 1 0 0 8 2 120190 0 0 1 1\n102\n1 1 0 1 8 3 120190 0 0 1 1\n103\n")

    def test_timers_start_and_end_by_the_clock_of_the_messages(self):
        text = """
import hypercolumn as hc
module = hc.Module("timers", "Has timers.")
numbers = module.input("numbers", hc.table(), "numbers")
rate = module.parameter("rate", 1.0, "Hz", "of a timer")
said = []
module.on_start(lambda: said.append("start"))
module.every(2.0)(lambda: said.append("two"))
module.every(rate)(lambda: said.append("one"))

@module.after(2.5)
def late():
    said.append("late")

@module.on(numbers)
def count(message):
    said.append(str(module.now() - message.time))
    if message.seq == 0:
        late.restart(3.5)

@module.on_end
def end():
    module.log(" ".join(said) + " end %g" % (module.now() * 1e-9))

module.run()
"""
        second = 10**9
        data = b"".join(
            b"1 1 0 %d 8 %d 120190 0 0 1 1\n0\n" % (i, (10 + 2 * i) * second) for i in range(3)
        )
        self.run_module(text, "--clock messages", data)
        said = self.err.split()
        self.assertEqual(said[:3], ["timers:", "start", "0"])
        self.assertEqual(said[-2:], ["end", "14"])
        self.assertEqual([said.count(word) for word in ("two", "one", "late", "0")], [2, 4, 1, 3])

    def test_it_hears_of_the_focus(self):
        text = """
import hypercolumn as hc
module = hc.Module("task", "Has a mode.")
numbers = module.input("numbers", hc.table(), "numbers")

@module.on(numbers)
def look(message):
    module.log("%d %s" % (module.focus, module.has_focus))

module.run()
"""
        self.write("focus", b"1 1 0 0 8 5 120150 0 0 1 1\n2\n1 1 0 0 8 9 120150 0 0 1 1\n3\n")
        self.write("in", b"1 1 0 0 8 6 120190 0 0 1 1\n0\n1 1 0 0 8 10 120190 0 0 1 1\n0\n")
        self.run_module(text, "--clock messages --in focus=focus --in numbers=in --mode 3")
        self.assertEqual(self.err, "task: 2 False\ntask: 3 True\n")

    def test_frames(self):
        text = """
import hypercolumn as hc
module = hc.Module("where", "Says where the left eye is.")
numbers = module.input("numbers", hc.table(), "numbers")
frames = hc.ModuleFrames(module)

@module.on(numbers)
def look(message):
    T = frames.nearest("head", "left_eye", message.time)
    module.log("%s %s" % (T.shape, abs(T[3] - [0, 0, 0, 1]).max() == 0))

    def known(pose):
        module.log("known" if pose is not None else "unknown")

    frames.when_known("head", "left_eye", message.time, known)
    try:
        frames.lookup("head", "nowhere", message.time)
    except hc.Error as error:
        module.log(error.code)

module.run()
"""
        self.run_module(text, "--in numbers=/dev/stdin", IN)
        lines = self.err.splitlines()
        self.assertEqual(lines[0], "where: (4, 4) True", lines)
        self.assertIn("known", "".join(lines))

    def test_the_interpreter_is_free_while_it_waits(self):
        text = """
import threading
import hypercolumn as hc
module = hc.Module("free", "Counts in another thread.")
numbers = module.input("numbers", hc.table(), "numbers")
counted, done = 0, False

def count():
    global counted
    while not done:
        counted += 1

@module.on_start
def begin():
    threading.Thread(target=count, daemon=True).start()

@module.every(0.5)
def look():
    global done
    done = True
    module.log("free" if counted > 1000 else "counted %d" % counted)
    raise SystemExit

module.run()
"""
        self.run_module(text, "--in unix-listen:@" + self.link()[4:])
        self.assertEqual(self.err, "free: free\n")

    def test_the_interpreter_is_free_after_a_message_and_between_many(self):
        text = """
import collections, os, signal, threading
import hypercolumn as hc
module = hc.Module("free", "Has another thread run beside a handler that is no Python code.")
numbers = module.input("numbers", hc.table(), "numbers")
kept = collections.deque(maxlen=1)
module.on(numbers)(kept.append)

def other():
    while not kept:
        pass
    module.log("free")
    os.kill(os.getpid(), signal.SIGTERM)

@module.on_start
def begin():
    threading.Thread(target=other, daemon=True).start()

module.run()
"""
        program = self.write_module("module", text)
        for source in "cat message; cat", 'yes "$(cat message)"':
            with self.subTest(source):
                self.write("message", IN)
                process = self.start("(%s) | exec %s" % (source, program), stdin=subprocess.PIPE)
                self.assertEqual(process.stderr.readline(), b"free: free\n")


if __name__ == "__main__":
    unittest.main()
