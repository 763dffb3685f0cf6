#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The programs of the documents, the templates and python/examples with hostile input: they drop
what is bad, handle what is good, and end with a status and a line, in bounded memory."""

import collections
import os
import pathlib
import re
import resource
import shutil
import socket
import subprocess
import sys
import threading
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "pipes"))

import extract  # noqa: E402
from harness import BUILD, Pipes, ROOT, SANITIZERS  # noqa: E402

HAS_PYTHON = bool(list(BUILD.glob("python/hypercolumn/_hypercolumn*.so")))
MOST_ADDRESSES = 2 << 30  # [byte]
MOST_MEMORY = 400 << 20  # [byte]
ENDLESS = 32 << 20  # a stream that has so many bytes would go on [byte]
FIRST, LAST = 111, 222  # times of the good messages

TABLE, POSITION, IMAGE = 1201, 103, 303  # type and components, as in a header's info
SCALARS = {"u8": (0, 1), "u16": (2, 2), "f32": (8, 4), "f64": (9, 8)}  # digit, bytes
TEXT, BINARY, ZSTD, JPEG = range(4)

Ended = collections.namedtuple("Ended", "status out err memory")


def message(kind, scalar, encoding, width, height, elements, time=150):
    info = kind * 100 + SCALARS[scalar][0] * 10 + encoding
    return b"1 7 0 0 8 %d %d 0 0 %d %d\n%s\n" % (time, info, width, height, elements)


def good(kind, time, encoding=BINARY):
    """A message with an answer: to find_ball, the image of a ball."""
    if kind == IMAGE and encoding == TEXT:
        row = b" ".join([b"200 20 20"] * 16)
        return message(IMAGE, "u8", TEXT, 16, 12, b"\n".join([row] * 12), time)
    if kind == IMAGE:
        return message(IMAGE, "u8", BINARY, 16, 12, b"\xc8\x14\x14" * (16 * 12), time)
    if kind == POSITION:
        return message(POSITION, "f64", TEXT, 1, 1, b"500 300 0", time)
    return message(TABLE, "f64", TEXT, 2, 1, b"1 2.5", time)


def framed(kind):
    """Messages that a reader can tell from the next: bad ones, and good ones that are unusual."""
    scalar, size = ("u8", 3) if kind == IMAGE else ("f64", 24 if kind == POSITION else 8)
    for sides in ((0, 0), (0, 4), (4, 0)):
        for encoding in (TEXT, BINARY):
            yield message(kind, scalar, encoding, *sides, b"")
    yield message(kind, scalar, BINARY, 1, 1, bytes(size))
    yield message(kind, scalar, BINARY, 3, 2, bytes(6 * size))
    yield message(kind, scalar, BINARY, 1500, 1000, bytes(1500000 * size))
    for other in {TABLE, POSITION, IMAGE} - {kind}:
        yield good(other, 150)
    wrong = "u16" if kind == IMAGE else "f32"
    yield message(
        kind, wrong, BINARY, 2, 2, bytes(4 * size // SCALARS[scalar][1] * SCALARS[wrong][1])
    )
    for encoding in (ZSTD, JPEG) if kind == IMAGE else (ZSTD,):
        yield message(kind, scalar, encoding, 8, 8, b"5\nxxxxx")
    if kind == TABLE:
        yield message(kind, scalar, TEXT, 200000, 1, b" ".join([b"0"] * 200000))
    if kind != IMAGE:
        for words in (b"nan nan nan", b"inf -inf 0"):
            count = 3 if kind == POSITION else 1
            yield message(kind, scalar, TEXT, 1, 1, b" ".join(words.split()[:count]))


def broken(kind):
    """Ends of streams after which nothing can be read, by their names."""
    whole = good(kind, LAST)
    huge = message(kind, "u8" if kind == IMAGE else "f64", BINARY, 31623, 31623, b"abc")
    return {
        "huge": huge,
        "garbage": bytes(range(255, -1, -1)) * 99,
        "truncated": whole[: len(whole) // 2],
        "without an end": b"1 7 0 " + b"0" * ENDLESS,
    }


class Examples(Pipes):
    def setUp(self):
        super().setUp()
        self.environment["PYTHONPATH"] = str(BUILD / "python")
        self.environment["OPENBLAS_NUM_THREADS"] = "1"  # each has address space

    def begin(self, command, has_limit=True, **options):
        def limit():
            if has_limit and not SANITIZERS:
                resource.setrlimit(resource.RLIMIT_AS, (MOST_ADDRESSES,) * 2)

        process = subprocess.Popen(
            command,
            cwd=self.folder.name,
            env=self.environment,
            start_new_session=True,
            preexec_fn=limit,
            **options,
        )
        self.addCleanup(self.end, process)
        return process

    def wait(self, process):
        """Waits for a process; gives its status, and the most memory that it had [byte]."""
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        return process.returncode, usage.ru_maxrss << 10

    def run_with(self, command, data):
        """Runs a program with data as its standard input, as far as it reads them."""
        with open(self.path("out"), "w+b") as out, open(self.path("err"), "w+b") as err:
            process = self.begin(command, stdin=subprocess.PIPE, stdout=out, stderr=err)

            def feed():
                try:
                    with process.stdin:
                        process.stdin.write(data)
                except BrokenPipeError:
                    pass

            feeder = threading.Thread(target=feed)
            feeder.start()
            status, memory = self.wait(process)
            feeder.join()
        return Ended(status, self.read_bytes("out"), self.read("err"), memory)

    def run_linked(self, command, data):
        """Runs a module that has no standard input, with links by TCP."""
        with socket.create_server(("127.0.0.1", 0)) as source, socket.create_server(
            ("127.0.0.1", 0)
        ) as sink, open(self.path("err"), "w+b") as err:
            uris = ["=tcp:%d" % each.getsockname()[1] for each in (source, sink)]
            links = ["--in", "numbers" + uris[0], "--out", "product" + uris[1]]
            process = self.begin([*command, *links], has_limit=False, stderr=err)
            received = []

            def feed():
                try:
                    with source.accept()[0] as link:
                        link.sendall(data)
                except ConnectionError:
                    pass

            def receive():
                with sink.accept()[0] as link, link.makefile("rb") as stream:
                    received.append(stream.read())

            threads = [threading.Thread(target=each) for each in (feed, receive)]
            for each in threads:
                each.start()
            status, memory = self.wait(process)
            for end in (source, sink):  # for who still waits for the module
                socket.create_connection(end.getsockname()).close()
            for each in threads:
                each.join()
        return Ended(status, received[0], self.read("err"), memory)

    def check_end(self, ended, statuses=(0, 1, 2), lines=4):
        """That a program has ended as it should, with at most so many lines of errors."""
        self.assertIn(ended.status, statuses, ended.err[-3000:])
        self.assertLessEqual(len(ended.err.splitlines()), lines, ended.err[-3000:])
        if ended.status != 0:
            self.assertTrue(ended.err.strip())
        self.assertNotIn("Sanitizer", ended.err)
        self.assertNotIn("runtime error", ended.err)
        if not SANITIZERS:
            self.assertLess(ended.memory, MOST_MEMORY)

    def check_answers(self, ended, *times):
        found = {int(each) for each in re.findall(rb"^1 \d+ 0 \d+ 8 (\d+) ", ended.out, re.M)}
        self.assertLessEqual(set(times), found)

    def check_module(self, command, kind, answers=True, own_lines=None):
        """A module whose messages are of a kind. @param own_lines  of its log, which are no errors."""

        def run(data):
            ended = self.run_with(command, data)
            if own_lines:
                err = re.sub("^%s.*\n" % own_lines, "", ended.err, flags=re.M)
                ended = ended._replace(err=err)
            return ended

        with self.subTest(command, case="framed"):
            ended = run(good(kind, FIRST) + b"".join(framed(kind)) + good(kind, LAST))
            self.check_end(ended, (1,))
            self.assertIn("dropped", ended.err)
            if answers:
                self.check_answers(ended, FIRST, LAST)
        for name, data in broken(kind).items():
            with self.subTest(command, case=name):
                ended = run(good(kind, FIRST) + data)
                self.check_end(ended, (1,))
                if answers:
                    self.check_answers(ended, FIRST)
        with self.subTest(command, case="many"):
            one = good(kind, 150)
            ended = run(good(kind, FIRST) + one * (ENDLESS // 4 // len(one)) + good(kind, LAST))
            self.check_end(ended, (0,))
            if answers:
                self.check_answers(ended, FIRST, LAST)

    def check_script(self, command, encoding=BINARY):
        """A script that reads images without the library: it need not go on, but end."""
        first, last = good(IMAGE, FIRST, encoding), good(IMAGE, LAST, encoding)
        both = first + message(IMAGE, "u8", encoding, 0, 4, b"") + last
        streams = {"empty": both, "framed": both + b"".join(framed(IMAGE)), **broken(IMAGE)}
        if encoding == TEXT:
            del streams["without an end"]  # awk reads whole lines
        for name, data in streams.items():
            with self.subTest(command, case=name):
                ended = self.run_with(command, data)
                self.check_end(ended, lines=12)
                if name == "empty":
                    self.check_answers(ended, FIRST, LAST)

    def example(self, name):
        return str(BUILD / "tests/examples" / name)

    def write_program(self, name, text):
        self.write(name, text, 0o755)
        return self.path(name)

    def scripts_of(self, document):
        """The files that the commands of a document write: {name: text}."""
        text = (ROOT / "doc" / document).read_text(encoding="utf8")
        return dict(re.findall(r"^cat >(\S+) <<'END'\n(.*?)^END$", text, re.M | re.S))

    def test_programs_of_the_documents(self):
        self.check_module([self.example("README_1")], TABLE)
        self.check_module([self.example("modules_1")], TABLE)
        self.check_module([self.example("modules_2")], IMAGE)
        listener = [self.example("coming_from_ros2_1")]
        self.check_module(listener, IMAGE, answers=False, own_lines="listener: first pixel")
        # Its answers wait for poses of the head.
        self.check_module([self.example("frames_1")], POSITION, answers=False)
        self.check_module([str(BUILD / "libexec/hypercolumn/brightness")], IMAGE)

    @unittest.skipUnless(HAS_PYTHON, "the Python package was not built")
    def test_the_readme_has_one_module_twice(self):
        python = next(text for path, _, text in extract.blocks("python") if path.stem == "README")
        commands = [self.example("README_1")], [self.write_program("sum", python)]
        tables = (
            (1, 1, b"3"),
            (2, 1, b"3 4"),
            (3, 2, b"3 4 5\n6 7 8.5"),
            (0, 2, b""),
            (1, 1, b"nan"),
        )
        data = b"".join(message(TABLE, "f64", TEXT, *each) for each in tables)
        numbers = [self.run_with(command, data).out.split(b"\n")[1::2] for command in commands]
        self.assertEqual(numbers, [[b"3", b"7", b"33.5", b"0", b"nan"]] * 2)

    @unittest.skipUnless(HAS_PYTHON, "the Python package was not built")
    def test_a_task_of_the_documents_does_not_read(self):
        nod = self.write_program("nod", self.scripts_of("tasks.md")["nod"])
        ended = self.run_with([nod], broken(TABLE)["garbage"])
        self.check_end(ended, (0,), 0)
        self.assertEqual(len(re.findall(rb"^1 \d+ 0 \d+ 8 ", ended.out, re.M)), 220)

    @unittest.skipUnless(HAS_PYTHON, "the Python package was not built")
    def test_modules_of_the_documents_in_python(self):
        scripts = {**self.scripts_of("python.md"), **self.scripts_of("tasks.md")}
        modules = {name: text for name, text in scripts.items() if "module.input(" in text}
        fragments = []
        for path, _, text in extract.blocks("python"):
            if "hc.Module(" in text:
                modules[path.stem] = text
            else:
                fragments.append(text)
        self.assertEqual(
            set(modules), {"README", "redness", "reddest", "find_ball", "api_beside_others"}
        )
        for name, text in modules.items():
            # One has its answer at the end, without a time.
            kind = TABLE if name == "README" else IMAGE
            self.check_module([self.write_program(name, text)], kind, answers=name != "reddest")
        edges = (ROOT / "python/examples/edges").read_text()
        for text in fragments:
            for line in text.splitlines():
                self.assertIn(line.split("  #")[0], edges)

    @unittest.skipUnless(HAS_PYTHON, "the Python package was not built")
    def test_examples_in_python(self):
        examples = ROOT / "python/examples"
        self.check_module([str(examples / "edges")], IMAGE)
        self.check_module([str(examples / "steer")], POSITION)
        # It can only say something once it has learned something.
        self.write("truth", message(6 * 100 + 1, "u8", TEXT, 3, 1, b"red", FIRST + 1))
        command = "classify --clock messages --in image=- --in truth=truth --out scores=-".split()
        self.check_classifier([str(examples / command[0]), *command[1:]])

    def check_classifier(self, command):
        with self.subTest(command):
            data = good(IMAGE, FIRST) + b"".join(framed(IMAGE)) + good(IMAGE, LAST)
            ended = self.run_with(command, data)
            self.check_end(ended, (0,))  # by the messages' clock, a recording with bad messages
            self.check_answers(ended, LAST)
            self.assertNotIn(b"nan", ended.out)

    @unittest.skipUnless(HAS_PYTHON, "the Python package was not built")
    def test_the_template_in_python(self):
        text = (ROOT / "templates/python/module").read_text().replace("@NAME@", "gauge")
        self.check_module([self.write_program("gauge", text)], TABLE)

    @unittest.skipUnless(HAS_PYTHON, "the Python package was not built")
    def test_a_script_that_reads_a_file(self):
        self.write("script.py", self.scripts_of("python.md")["script.py"])
        streams = {"framed": b"".join(framed(IMAGE)), **broken(IMAGE)}
        for name, data in streams.items():
            with self.subTest(name):
                self.write("images.mtp", good(IMAGE, FIRST) + data)
                ended = self.run_with(["python3", "script.py"], b"")
                self.check_end(ended, (1,), 12)
                self.assertTrue(ended.out.startswith(b"0 (12, 16, 3) uint8\n"), ended.out)

    def check_language(self, language):
        shutil.copy(ROOT / "templates" / language / "module", self.path("module"))
        first, last = good(TABLE, FIRST), good(TABLE, LAST)
        many = last * (ENDLESS // 8 // len(last))
        streams = {"framed": b"".join(framed(TABLE)) + last, "many": many}
        for name, data in {**streams, **broken(TABLE)}.items():
            with self.subTest(name):
                ended = self.run_linked([self.path("module")], first + data)
                self.check_end(ended, (0,) if name in streams else (1,))
                self.check_answers(ended, FIRST, *([LAST] if name in streams else []))

    @unittest.skipUnless(shutil.which("node"), "Node.js is not installed")
    def test_the_template_in_javascript(self):
        self.check_language("javascript")

    @unittest.skipUnless(shutil.which("javac"), "a JDK is not installed")
    def test_the_template_in_java(self):
        # As much as it takes without a limit, and faster to start.
        self.environment["JDK_JAVA_OPTIONS"] = "-Xmx256m -XX:TieredStopAtLevel=1 -XX:+UseSerialGC"
        self.check_language("java")

    def test_scripts_without_the_library(self):
        self.write("mean.py", self.scripts_of("languages.md")["mean.py"])
        self.check_script(["python3", "mean.py"])
        self.check_script(["awk", "-f", str(ROOT / "modules/brightness/brightness.awk")], TEXT)


if __name__ == "__main__":
    unittest.main()
