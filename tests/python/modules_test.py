#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Modules written in Python: what they say of themselves, what they send, how they end."""

import gc
import pathlib
import signal
import subprocess
import unittest
import weakref

import numpy

from package import Package, hc

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
ECHO = """
import hypercolumn as hc
module = hc.Module("echo", "Sends what comes.")
numbers = module.input("numbers", hc.table(), "any numbers")
out = module.output("out", hc.%s, "what it is made into")

@module.on(numbers)
def echo(message):
    %s

module.run()
"""
IN = b"1 7 0 0 8 55 120190 3 0 3 1\n1 2.5 -3\n"


class Modules(Package):
    def run_module(self, text, arguments="", data=b"", status=0):
        program = self.write_module("module", text)
        out = self.shell(program + " " + arguments, status, data)
        return out

    def echo(self, kind, body, arguments="", data=IN, status=0):
        return self.run_module(ECHO % (kind, body), arguments, data, status)


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


class Ended(Modules):
    def test_an_exception_ends_it_with_a_traceback_and_a_line(self):
        self.echo("table()", "1 / 0", status=1)
        lines = self.err.splitlines()
        self.assertEqual(lines[0], "Traceback (most recent call last):")
        self.assertIn("in echo", self.err)
        self.assertEqual(lines[-1], "echo: ZeroDivisionError: division by zero")

    def test_a_bad_message_is_dropped_and_the_next_handled(self):
        body = "if message.numbers[0] == 1: raise hc.BadMessage('it is one')\n    out.send(message)"
        data = IN + IN.replace(b"1 2.5", b"7 2.5")
        self.assertIn("\n7 2.5 -3\n", self.echo("table()", body, "", data, status=1))
        self.assertIn("echo: numbers: dropped: it is one", self.err)
        self.assertIn("echo: total: 1 bad at numbers", self.err)

    def test_an_index_that_is_not_there_drops_the_message(self):
        empty = b"1 7 0 0 8 55 120190 0 0 0 0\n\n"
        for body, text in (
            ("out.send(message.numbers[2])", "tuple index out of range"),
            ("out.send(message.matrix[0, 0])", "index 0 is out of bounds for axis 0 with size 0"),
        ):
            with self.subTest(body):
                out = self.echo("table()", body, "", empty + IN, status=1)
                self.assertEqual(len(out.splitlines()), 2)
                dropped, total = self.err.splitlines()
                self.assertEqual(
                    dropped.split(" (further")[0],
                    "echo: numbers: dropped: IndexError: %s (module, line 10)" % text,
                )
                self.assertEqual(total, "echo: total: 1 bad at numbers")

    def test_an_image_that_opencv_refuses_is_dropped(self):
        empty = b"1 7 0 0 8 55 120190 0 0 0 0\n\n"
        body = "import cv2; cv2.resize(message.matrix, (2, 2)); out.send(1)"
        out = self.echo("table()", body, "", empty + IN, status=1)
        self.assertEqual(len(out.splitlines()), 2)
        dropped, total = self.err.splitlines()
        self.assertIn("echo: numbers: dropped: cv2.error: OpenCV(", dropped)
        self.assertIn("(module, line 10)", dropped)
        self.assertEqual(total, "echo: total: 1 bad at numbers")

    def test_an_index_error_without_a_message_ends_it(self):
        text = """
import hypercolumn as hc
module = hc.Module("source", "Sends nothing.")

@module.on_start
def begin():
    [][0]

module.run()
"""
        self.shell(self.write_module("source", text), 1)
        self.assertEqual(self.err, "source: IndexError: list index out of range (source, line 8)\n")

    def test_an_error_ends_it_with_a_line(self):
        self.echo("table()", "raise hc.Error('no face in sight')", status=1)
        self.assertEqual(self.err, "echo: no face in sight\n")
        self.echo("table()", "raise hc.Error('Invalid: x: too old', 'Invalid')", status=2)
        self.assertEqual(self.err, "echo: Invalid: x: too old\n")

    def test_a_message_that_does_not_fit_is_dropped_as_in_cpp(self):
        self.echo("table()", "pass", data=b"1 1 0 0 8 0 30301 0 0 1 1\nabc\n", status=1)
        dropped, total = self.err.splitlines()
        text = "echo: numbers: dropped: Malformed: R17 info: rgb_image does not fit"
        self.assertTrue(dropped.startswith(text), dropped)
        self.assertEqual(total, "echo: total: 1 bad at numbers")

    def test_it_ends_when_nobody_reads_and_no_handler_can_catch_that(self):
        text = """
import hypercolumn as hc
module = hc.Module("source", "Sends numbers.")
out = module.output("out", hc.table(), "numbers")

@module.generate
def more():
    try:
        out.send(1)
    except Exception as error:
        module.log("caught " + repr(error))

module.run()
"""
        program = self.write_module("module", text)
        self.shell("%s | head -c 100; exit ${PIPESTATUS[0]}" % program)
        self.assertEqual(self.err, "")

    def test_exit_and_interrupt(self):
        self.echo("table()", "raise SystemExit(7)", status=7)
        self.assertEqual(self.err, "")
        text = ECHO % ("table()", "pass") + 'print("after", module.name)\n'
        self.assertEqual(self.run_module(text, data=IN), "after echo\n")
        program = self.write_module("module", text)
        process = self.start(
            "exec %s --in 'unix-listen:@%s'" % (program, self.link()[4:]), stderr=-1
        )
        self.wait_for_socket(self.link()[4:])
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
        self.assertEqual((process.returncode, out, err), (0, b"after echo\n", b""))

    def test_its_end_is_called_when_it_is_asked_to_stop(self):
        text = """
import hypercolumn as hc
module = hc.Module("ends", "Says when it ends.")
numbers = module.input("numbers", hc.table(), "numbers")
module.on_start(lambda: module.log("started"))
module.on_end(lambda: module.log("ended"))
"""
        for body, last in (
            ("module.on(numbers)(print)\nmodule.run()", []),
            ("module.every(60)(print)\nmodule.run()", []),
            ("module.generate(lambda: module.keep_rate(10))\nmodule.run()", []),
            ("for message in numbers: pass\nmodule.log('after')", [b"ends: after"]),
        ):
            program = self.write_module("module", text + body)
            for number in signal.SIGTERM, signal.SIGINT, signal.SIGHUP:
                with self.subTest(body=body, number=number):
                    process = self.start(
                        "exec %s --in unix-listen:@%s" % (program, self.link()[4:]), stderr=-1
                    )
                    self.assertEqual(process.stderr.readline(), b"ends: started\n")
                    process.send_signal(number)
                    _, err = process.communicate(timeout=60)
                    self.assertEqual(process.returncode, 0, err)
                    self.assertEqual(err.splitlines(), [*last, b"ends: ended"])
        # The graph that it is in, too.
        self.write("g.toml", 'version = 1\n[modules.ends]\nprogram = "%s"\n' % program)
        graph = self.start("exec hc run g.toml", stderr=-1)
        while b"ends: started" not in graph.stderr.readline():
            continue
        graph.send_signal(signal.SIGINT)
        _, err = graph.communicate(timeout=60)
        self.assertIn(b"ends: ended\n", err)

    def wait_for_socket(self, name):
        from package import wait_until

        wait_until(lambda: "@" + name in pathlib.Path("/proc/net/unix").read_text())

    def test_what_is_printed_does_not_go_into_the_messages(self):
        out = self.echo("table()", "print('hello'); out.send(1)")
        self.assertEqual(out, "1 1 0 0 8 55 120190 3 0 1 1\n1\n")
        self.assertEqual(self.err, "hello\n")

    def test_another_thread_cannot_use_it(self):
        body = """
    from threading import Thread
    for use in uses:
        def other():
            try:
                use()
                module.log("done")
            except hc.Error as error:
                module.log(error.code + " " + str(error))
        thread = Thread(target=other)
        thread.start()
        thread.join()
"""
        uses = """
gain = module.parameter("gain", 1.0, "", "a number")
frames = hc.ModuleFrames(module)
timer = module.after(9)(print)
uses = [
    lambda: out.send(1),
    lambda: out.loan(1, 1),
    lambda: out.linked,
    lambda: gain.value,
    lambda: frames.lookup("head", "robot", 5),
    lambda: frames.nearest("head", "robot", 5),
    lambda: frames.when_known("head", "robot", 5, print),
    lambda: timer.restart(1),
    timer.stop,
    lambda: module.keep_rate(1),
    module.stop,
    lambda: module.focus,
    lambda: module.has_focus,
    lambda: module.log_once("kind", "line"),
    module.now,
    lambda: module.every(1)(print),
    lambda: module.input("more", hc.table(), "more"),
]

@module.on(numbers)
"""
        text = (ECHO % ("table()", body)).replace("\n@module.on(numbers)\n", uses)
        self.assertEqual(self.run_module(text, "--in numbers=/dev/stdin", IN), "")
        lines = self.err.splitlines()
        self.assertEqual(len(lines), 17)
        for line in lines:
            self.assertIn(
                "Invalid: a module, its ports and parameters may only be used on the thread", line
            )

    def test_a_module_owns_what_is_made_of_it(self):
        self.environment["MALLOC_PERTURB_"] = "85"  # freed memory holds other bytes
        text = """
import gc
import hypercolumn as hc

module = hc.Module("frames", "Has dropped its frames.")
hc.ModuleFrames(module)
gc.collect()
module.on_end(lambda: module.log("end"))
module.run()
"""
        pose = b"1 1 0 0 8 5 70190 2001 0 4 4\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"
        self.run_module(text, "--in frames=/dev/stdin", pose, 1)  # of no frame: it is bad
        self.assertIn("frames: end", self.err)
        for make in (
            lambda module: module.after(1)(print),
            lambda module: module.parameter("rate", 2.0, "Hz", "a rate"),
        ):
            module = hc.Module("m", "a module")
            made, owner = make(module), weakref.ref(module)
            del module
            gc.collect()
            self.assertIsNotNone(owner())
            del made

    def test_the_frames_of_a_module_are_the_same(self):
        module = hc.Module("m", "a module")
        hc.ModuleFrames(module)
        self.assertEqual(
            hc.ModuleFrames(module).lookup("head", "head", 5).tolist(), numpy.eye(4).tolist()
        )

    def test_handlers_that_never_run_are_said(self):
        text = ECHO % ("table()", "out.send(message)")
        self.run_module(text.replace("module.run()", ""), data=IN)
        self.assertIn("never called: end the program with module.run()", self.err)
        self.echo("table()", "out.send(message)")
        self.assertNotIn("never called", self.err)


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
