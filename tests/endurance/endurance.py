# SPDX-License-Identifier: Apache-2.0
"""What the tests of endurance share. They are small, and assert events alone, unless HC_FULL=1 is
in the environment: then they are as long as the figures want, and assert the times too.

    many_test.py BUILD_FOLDER [TEST …], and so the others
"""

import contextlib
import os
import pathlib
import random
import signal
import sys
import time

ROOT = pathlib.Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests/pipes"))

from graphs import Graphs  # noqa: E402
from harness import BUILD, WATCHDOG, wait_until  # noqa: E402

IS_FULL = os.environ.get("HC_FULL") == "1"
CHECKER = BUILD / "tests/endurance_checker"
IMAGES = """
[modules.camera]
parameters = { source = "image.ppm", loop = true, rate = 30 }
[modules.relay]
[modules.near]
program = "%(checker)s"
parameters = { log = "near.log" }
[modules.far]
program = "%(checker)s"
parameters = { log = "far.log" }
[[modules.relay.inputs.in]]
from = "camera.left"
[[modules.near.inputs.in]]
from = "relay.out"
[[modules.far.inputs.in]]
from = "relay.out"
""" % dict(
    checker=CHECKER
)


def ring(names):
    """A graph of relays through which nothing goes."""
    modules = ["[modules.%s]\nprogram = 'relay'\n" % name for name in names]
    pairs = zip(names, names[1:] + names[:1])
    links = [
        "[[modules.%s.inputs.in]]\nfrom = '%s.out'\n" % (reader, writer) for writer, reader in pairs
    ]
    return "".join(modules + links) + "rate = 30\n"  # a loop has a rate somewhere (hc check)


def report(text, *values):
    """One figure, with how busy the machine was."""
    print("%s  (load %.1f)" % (text % values, os.getloadavg()[0]), flush=True)


def quantile(values, part):
    return sorted(values)[min(len(values) - 1, int(part * len(values)))]


def processes_of(session):
    """The processes of a session, hc run's included, and not those that wait to be reaped."""
    found = []
    for entry in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            words = (entry / "stat").read_text().rsplit(") ", 1)[1].split()
        except (OSError, IndexError):
            continue
        if int(words[3]) == session and words[0] not in "ZX":
            found.append(int(entry.name))
    return found


def processor_time(processes):
    """What all threads of these have used so far [s]."""
    total = 0
    for process in processes:
        for thread in pathlib.Path("/proc/%d/task" % process).iterdir():
            total += int((thread / "schedstat").read_text().split()[0])
    return total / 1e9


def memory(process):
    """The share of memory (PSS) [byte]."""
    for line in pathlib.Path("/proc/%d/smaps_rollup" % process).read_text().splitlines():
        if line.startswith("Pss:"):
            return int(line.split()[1]) << 10
    return 0


class Endurance(Graphs):
    def begin(self, text, options=""):
        """A graph that runs, once it can be observed; what it says goes into a file."""
        self.write_graph(text)
        image = pathlib.Path(self.path("image.ppm"))
        if not image.exists():
            size = 800 * 600 * 3
            image.write_bytes(b"P6 800 600 255\n" + random.Random(1).randbytes(size))
        return self.start("exec hc run g.toml %s >>out 2>>errors" % options, stdout=-3, stderr=-3)

    @contextlib.contextmanager
    def observing(self, process):
        """An observer that leaves again."""
        messages = self.observed(process)
        try:
            yield messages
        finally:
            messages.close()

    def said(self):
        return self.read("errors")[-3000:]

    def state(self, messages, condition=lambda state: True):
        try:
            return super().state(messages, condition)
        except OSError:
            self.fail(self.said())

    def halt(self, process):
        """Ends a graph as Ctrl-C does, and returns how long that took [s]."""
        begun = time.monotonic()
        os.kill(process.pid, signal.SIGINT)
        self.assertEqual(process.wait(timeout=WATCHDOG), 0, self.said())
        return time.monotonic() - begun

    def lines(self, name):
        return [line.split() for line in self.read(name + ".log").splitlines()]

    def noted(self, name):
        """What a checker has noted: times [s], numbers and hashes."""
        return [(int(at) / 1e9, int(seq), hash) for at, seq, hash, _ in self.lines(name)]

    def check_noted(self, *names):
        """One still image was sent: all are the same."""
        hashes = {each[2] for name in names for each in self.noted(name)}
        self.assertEqual(len(hashes), 1, hashes)

    def await_message(self, name, after):
        """When the first message behind a moment came [s]."""
        path = pathlib.Path(self.path(name + ".log"))
        found = []

        def has_come():
            if not path.exists():
                return False
            size = path.stat().st_size
            with path.open() as file:
                file.seek(max(0, size - 4096))
                lines = file.read().splitlines()
            lines = lines[1:] if size > 4096 else lines
            found[:] = [t for t in (int(line.split()[0]) / 1e9 for line in lines) if t > after]
            return found

        wait_until(has_come)
        return found[0]

    def limit(self, value, most, what):
        """Asserts a figure where the run is a full one."""
        if IS_FULL:
            self.assertLessEqual(value, most, what)
