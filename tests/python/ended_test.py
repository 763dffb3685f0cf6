#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How modules written in Python end, and what they drop."""

import gc
import pathlib
import signal
import unittest
import weakref

import numpy

from package import ECHO, IN, Modules, hc


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
            (  # which NumPy's Python raises
                "import numpy; numpy.take(message.matrix, 0); out.send(1)",
                "cannot do a non-empty take from an empty axes.",
            ),
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
import pathlib
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


if __name__ == "__main__":
    unittest.main()
