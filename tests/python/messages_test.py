#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Messages in Python: their fields, numpy arrays in the publisher's memory, and what holds that."""

import gc
import os
import shutil
import signal
import sys
import threading
import unittest
import warnings

import numpy

from package import BUILD, Package, hc, is_shared, wait_until

FULL = os.environ.get("HC_FULL") == "1"
KEPT = 40  # messages of a publisher's memory that are kept at most


def resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE")


class Fields(Package):
    def read(self, data):
        self.write("x.mtp", data)
        return list(hc.read(self.path("x.mtp")))

    def test_header_and_numbers(self):
        data = b"1 12 3 1042 7 1763683200123456789 10390 2 3 2 1\n1 2 3 4 5 6.5\n"
        (m,) = self.read(data)
        fields = (m.src, m.dst, m.seq, m.ttl, m.time, m.mode, m.coord, m.width, m.height)
        self.assertEqual(fields, (12, 3, 1042, 7, 1763683200123456789, 2, 3, 2, 1))
        kind = (m.type, m.components, m.scalar, m.encoding)
        self.assertEqual(kind, ("position", 3, "f64", "text"))
        self.assertEqual(m.numbers, (1.0, 2.0, 3.0, 4.0, 5.0, 6.5))
        self.assertEqual(m.matrix.tolist(), [[[1, 2, 3], [4, 5, 6.5]]])
        self.assertIn("position 2 x 1 of 3 x f64", repr(m))

    def test_every_scalar_has_its_dtype(self):
        for scalar, name in enumerate("u1 i1 u2 i2 u4 i4 u8 i8 f4 f8".split()):
            dtype = numpy.dtype(name)
            numbers = numpy.array([[0, 1, 100]], dtype)
            header = b"1 1 0 0 8 0 1201%d1 0 0 3 1\n" % scalar
            (message,) = self.read(header + numbers.tobytes() + b"\n")
            self.assertEqual(message.matrix.dtype, dtype)
            self.assertEqual(message.matrix.tolist(), [[0, 1, 100]])
            self.assertEqual(message.numbers, (0, 1, 100))
            self.assertEqual(message.scalar, "%s%d" % (name[0], 8 * int(name[1])))

    def test_shapes(self):
        (grey,) = self.read(b"1 1 0 0 8 0 40101 0 0 3 2\n" + bytes(6) + b"\n")
        self.assertEqual(grey.matrix.shape, (2, 3))
        (colour,) = self.read(b"1 1 0 0 8 0 30301 0 0 3 2\n" + bytes(18) + b"\n")
        self.assertEqual(colour.matrix.shape, (2, 3, 3))
        (empty,) = self.read(b"1 1 0 0 8 0 120190 0 0 0 4\n\n")
        self.assertEqual((empty.matrix.shape, empty.numbers), ((4, 0), ()))

    def test_text(self):
        (one,) = self.read(b"1 1 0 0 8 0 60100 0 0 5 1\nm\xc3\xbcd \n")
        self.assertEqual(one.text, "müd ")
        (rows,) = self.read(b"1 1 0 0 8 0 60100 0 0 2 2\na bc\n")
        self.assertEqual(rows.text, "a\nbc")
        (table,) = self.read(b"1 1 0 0 8 0 120190 0 0 1 1\n1\n")
        with self.assertRaisesRegex(hc.Error, "no text: the message is a table"):
            table.text

    def test_missing_numpy_is_named(self):
        self.shell(
            """python3 -c 'import sys; sys.modules["numpy"] = None; import hypercolumn'""", 1
        )
        self.assertIn("ImportError: hypercolumn needs numpy, which /", self.err.splitlines()[-1])

    def test_another_python_is_named(self):
        shutil.copytree(
            BUILD / "python/hypercolumn",
            self.path("hypercolumn"),
            ignore=shutil.ignore_patterns("*.so", "__pycache__"),
        )
        self.environment["PYTHONPATH"] = self.path("")
        self.shell("python3 -c 'import hypercolumn'", 1)
        self.assertIn("/hypercolumn is not built: build it with ./dev build", self.err)
        self.write("hypercolumn/_hypercolumn.cpython-30-x86_64-linux-gnu.so", "")
        self.shell("python3 -c 'import hypercolumn'", 1)
        said = self.err.splitlines()[-1]
        self.assertIn("ImportError: hypercolumn was built for another Python than /", said)
        self.assertIn("hypercolumn has _hypercolumn.cpython-30-x86_64-linux-gnu.so; ", said)

    def test_without_memory_it_raises(self):
        self.write("x.mtp", b"1 1 0 0 8 0 60100 0 0 32000000 2\n" + b"x" * (64 * 10**6) + b"\n")
        self.write(
            "program.py",
            """
import resource
import hypercolumn as hc
(message,) = hc.read("x.mtp")
resident = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (resident + (16 << 20), -1))
for use in (message.copy, lambda: message.text, lambda: message.numbers):
    try:
        use()
    except (MemoryError, hc.Error) as error:
        print(type(error).__name__)
""",
        )
        out = self.shell("python3 program.py")
        self.assertEqual(out, "MemoryError\nMemoryError\nMemoryError\n")

    def test_what_is_compressed_is_expanded(self):
        self.shell("hc send --encoding zstd 1 2 3 >z.mtp")
        (message,) = hc.read(self.path("z.mtp"))
        self.assertEqual((message.numbers, message.encoding), ((1, 2, 3), "binary"))

    def test_recordings_in_mcap(self):
        self.write("x", b"1 4 0 0 8 5 120190 0 0 2 1\n1 2.5\n1 5 0 1 8 6 120190 0 0 1 1\n3\n")
        self.shell("to_mcap x.mcap <x")
        path = self.path("x.mcap")
        kept = [(m.src, m.seq, m.time, m.numbers) for m in hc.read(path)]
        self.assertEqual(kept, [(4, 0, 5, (1, 2.5)), (5, 1, 6, (3,))])
        with self.assertRaises(hc.Error) as caught:
            list(hc.read(path, "no.such"))
        self.assertEqual(caught.exception.code, "NotFound")
        (chosen,) = hc.read(path, "src_5")
        self.assertEqual(chosen.src, 5)

    def test_a_stream_of_a_folder(self):
        self.shell("mkdir kept empty; for i in 1 2; do hc send $i >kept/m.out_$i.mtp; done")
        (message,) = hc.read(self.path("kept"), "m.out_2")
        self.assertEqual(message.numbers, (2,))
        self.assertEqual([m.numbers for m in hc.read(self.path("kept"))], [(1,), (2,)])
        for folder, stream, text in (
            ("kept", "m.out", 'no stream "m.out", did you mean "m.out_'),
            ("empty", "", "no MODULE.PORT.mtp in it"),
        ):
            with self.subTest(text), self.assertRaisesRegex(hc.Error, text) as caught:
                hc.read(self.path(folder), stream)
            self.assertEqual(caught.exception.code, "NotFound")

    def test_errors_are_those_of_the_commands(self):
        self.write("bad.mtp", b"1 1 0 0 8 0 120190 0 0 2 1\n1 x\n")
        with self.assertRaises(hc.Error) as caught:
            list(hc.read(self.path("bad.mtp")))
        self.assertEqual(caught.exception.code, "Malformed")
        self.assertIn("R27", str(caught.exception))
        self.shell("hc cat bad.mtp", 1)
        self.assertIn(str(caught.exception).split(": ", 2)[2], self.err)
        with self.assertRaises(hc.Error) as caught:
            hc.read(self.path("missing"))
        self.assertEqual(caught.exception.code, "NotFound")
        with self.assertRaises(hc.Error) as caught:
            hc.open("tpc:1")
        self.assertEqual(caught.exception.code, "Invalid")
        with self.assertRaises(hc.Error) as caught:
            list(hc.read(self.path("bad.mtp"), limit=1))
        self.assertEqual(caught.exception.code, "TooLarge")

    def test_images_are_shown_in_notebooks(self):
        import cv2

        pixels = numpy.arange(2 * 3 * 3, dtype=numpy.uint8).reshape(2, 3, 3)
        (image,) = self.read(b"1 1 0 0 8 0 30301 0 0 3 2\n" + pixels.tobytes() + b"\n")
        decoded = cv2.imdecode(numpy.frombuffer(image._repr_png_(), numpy.uint8), -1)
        self.assertEqual(decoded[..., ::-1].tolist(), pixels.tolist())
        depth = numpy.array([[1, numpy.nan, 3], [2, numpy.inf, 1]], numpy.float32)
        (image,) = self.read(b"1 1 0 0 8 0 40181 0 0 3 2\n" + depth.tobytes() + b"\n")
        decoded = cv2.imdecode(numpy.frombuffer(image._repr_png_(), numpy.uint8), -1)
        self.assertEqual(decoded.tolist(), [[0, 0, 255], [127, 255, 0]])
        clear = numpy.arange(2 * 3 * 4, dtype=numpy.uint8).reshape(2, 3, 4)
        (image,) = self.read(b"1 1 0 0 8 0 30401 0 0 3 2\n" + clear.tobytes() + b"\n")
        decoded = cv2.imdecode(numpy.frombuffer(image._repr_png_(), numpy.uint8), -1)
        self.assertEqual(decoded[..., [2, 1, 0, 3]].tolist(), clear.tolist())
        (table,) = self.read(b"1 1 0 0 8 0 120190 0 0 1 1\n1\n")
        self.assertIsNone(table._repr_png_())


class Memory(Package):
    def test_an_array_is_in_the_memory_of_the_publisher(self):
        _, stream = self.publish()
        array = next(stream).matrix
        self.assertTrue(is_shared(array))
        self.assertFalse(array.flags.writeable)
        self.assertFalse(is_shared(next(stream).copy().matrix))
        with self.assertRaises(ValueError):
            array[0, 0] = 1
        with self.assertRaises(ValueError):
            array[0].flags.writeable = True
        self.assertEqual((array.shape, array.dtype), ((600, 800, 3), numpy.uint8))

    def test_a_slot_returns_with_the_last_view(self):
        # Room for five images: the publisher waits while all of them are held.
        _, stream = self.publish(uri_options="readers=1&memory=8M")
        held = [next(stream).matrix[0, 0] for _ in range(3)]
        while (message := stream.take(0.5)) is not None:
            held.append(message.matrix[1:])
        del message
        self.assertLess(len(held), 7)
        count = len(held)
        held[1:] = []
        gc.collect()
        self.assertEqual(int(next(stream).matrix[0, 0, 0]), count)
        self.assertEqual(int(held[0][0]), 0)
        for _ in range(100):  # each slot many times
            next(stream)

    def test_an_array_outlives_message_and_link(self):
        process, stream = self.publish("--count 3")
        messages = list(stream)
        arrays = [message.matrix for message in messages]
        del messages
        stream.close()
        process.wait()
        gc.collect()
        for i, array in enumerate(arrays):
            self.assertTrue(is_shared(array))
            self.assertTrue((array == i).all())
        del array, arrays
        self.assertEqual(next(stream, None), None)

    def test_what_is_held_stays_when_the_publisher_is_killed(self):
        process, stream = self.publish()
        array = next(stream).matrix
        process.send_signal(signal.SIGKILL)
        process.wait()
        with self.assertRaises(hc.Error) as caught:
            for message in stream:
                pass
        self.assertEqual(caught.exception.code, "Closed")
        self.assertTrue((array == 0).all())

    def test_too_many_are_told_with_the_line_and_copied(self):
        _, stream = self.publish()
        kept = []
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            for _ in range(KEPT + 10):
                message = next(stream)
                kept.append(message.matrix)
                line = sys._getframe().f_lineno - 1
        self.assertEqual(len(caught), 1)
        self.assertEqual((caught[0].filename, caught[0].lineno), (__file__, line))
        self.assertIn("%d messages of " % KEPT, str(caught[0].message))
        self.assertEqual([is_shared(array) for array in kept], [True] * KEPT + [False] * 10)
        for i, array in enumerate(kept):
            self.assertTrue((array == i).all())
        kept.clear()
        del message, array
        self.assertTrue(is_shared(next(stream).matrix))

    def test_messages_leak_nothing(self):
        count = 1000000 if FULL else 100000
        rows = b"".join(b"1 1 0 %d 8 5 10391 0 3 1 1\n%s\n" % (i, bytes(24)) for i in range(1000))
        self.write("many.mtp", rows * (count // 1000))
        _, images = self.publish("--height 10")
        taken, early = 0, 0
        for message in hc.read(self.path("many.mtp")):
            self.assertEqual(len(message.numbers) + message.matrix.size, 6)
            image = next(images)
            image.matrix[0, 0], image.time, image.type
            taken += 1
            if taken == count // 5:
                early = resident()
        self.assertEqual(taken, count)
        self.assertLess(resident() - early, 4 << 20)

    def test_a_handler_of_a_million_messages_leaks_nothing(self):
        rows = b"".join(b"1 1 0 %d 8 5 10391 0 3 1 1\n%s\n" % (i, bytes(24)) for i in range(1000))
        self.write("many.mtp", rows * 1000)
        program = self.write_module(
            "module",
            """
import os
import hypercolumn as hc
module = hc.Module("adder", "Adds what a position has.")
position = module.input("position", hc.position(), "a position")
total = module.output("sum", hc.table(), "the sum of its numbers")
taken, early = 0, 0

def resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE")

@module.on(position)
def add(message):
    global taken, early
    total.send(sum(message.numbers) + message.matrix.size)
    taken += 1
    if taken == 200000:
        early = resident()

@module.on_end
def end():
    module.log("%d %d" % (taken, resident() - early))

module.run()
""",
        )
        self.shell(program + " --in many.mtp --out /dev/null")
        taken, grown = map(int, self.err.split(":")[1].split())
        self.assertEqual(taken, 1000000)
        self.assertLess(grown, 1 << 20)


class Waiting(Package):
    def test_other_threads_run_meanwhile(self):
        stream = hc.open("unix-listen:@" + self.link()[4:])
        counted, done = 0, threading.Event()

        def count():
            nonlocal counted
            while not done.is_set():
                counted += 1

        thread = threading.Thread(target=count)
        thread.start()
        wait_until(lambda: counted > 0)
        before = counted
        self.assertIsNone(stream.take(0.5))
        done.set()
        thread.join()
        self.assertGreater(counted - before, 1000)

    def test_a_stream_is_of_one_thread_at_a_time(self):
        stream = hc.open("unix-listen:@" + self.link()[4:])
        thread = threading.Thread(target=stream.take, args=(1.0,))
        thread.start()
        refused = None
        while thread.is_alive() and refused is None:
            try:
                stream.take(0)
            except hc.Error as error:
                refused = error
        thread.join()
        self.assertIn("another thread reads", str(refused))

    def test_ctrl_c_ends_a_wait(self):
        code = (
            """
import hypercolumn as hc
stream = hc.open("unix-listen:@%s")
try:
    print("waits", flush=True)
    next(stream)
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
            % self.link()[4:]
        )
        process = self.start("exec python3 -c '%s'" % code)
        self.assertEqual(process.stdout.readline(), b"waits\n")
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.communicate(timeout=60), (b"interrupted\n", b""))

    def test_links_are_read_as_they_come(self):
        process = self.start(
            "(sleep 0.1; hc send 1 2) | python3 -c '%s'"
            % ('import hypercolumn as hc; print([m.numbers for m in hc.open("-")])')
        )
        self.assertEqual(process.communicate(timeout=60)[0], b"[(1.0, 2.0)]\n")


if __name__ == "__main__":
    unittest.main()
