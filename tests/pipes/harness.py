# SPDX-License-Identifier: Apache-2.0
"""What the tests of whole programs share: a folder, a shell in it, and events to wait for.

    graph_test.py BUILD_FOLDER [TEST …], and so the others
"""

import collections
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).parents[2]
DATA = os.environ.get("HC_DATA", "/usr/share/doc/opencv-doc/examples/data")
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
SANITIZERS = re.search(
    r"^HC_SANITIZE:STRING=(.*)$", (BUILD / "CMakeCache.txt").read_text(), re.MULTILINE
)[1]
# ThreadSanitizer takes 5 to 15 times as long: no depth of large images is in time.
if_quick = unittest.skipIf("thread" in SANITIZERS, "too slow with ThreadSanitizer")
PYTHON = "/usr/bin/python3"  # the one that the system's NumPy belongs to
WATCHDOG = 100  # seconds after which a program hangs
LONGEST = 300  # a test, unless HC_FULL=1 [s]
KILL = os.kill

Message = collections.namedtuple(
    "Message", "src dst seq ttl time info mode coord width height rows"
)


def messages_of(text):
    """Messages in text, but for one that is not whole yet: rows of numbers, or one of characters."""
    lines, found, at = text.split("\n")[:-1], [], 0
    while at < len(lines):
        header = [int(word) for word in lines[at].split()]
        is_string = header[6] // 10000 == 6
        end = at + 1 + (1 if is_string else header[10])
        if end > len(lines):
            break
        rows = lines[at + 1 : end]
        if not is_string:
            rows = [[float(word) for word in row.split()] for row in rows]
        found.append(Message(*header[1:], rows))
        at = end
    return found


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def wait_until(condition):
    """Waits for an event that gives no notice; gives what the condition gave."""
    end = time.monotonic() + WATCHDOG
    while not (result := condition()):
        assert time.monotonic() < end, "nothing happened"
        time.sleep(0.01)
    return result


def kill_process(pid, number):
    """As os.kill(), for tests that have a process from a state, where it is 0 while it is started
    anew: that would be the group of this test, and of what runs all tests."""
    assert pid > 0, "there is no process %d" % pid
    KILL(pid, number)


os.kill = kill_process


def end_when_hung(test):
    """Has a test fail where it is when it takes too long: events may come for ever, but not that
    which it waits for."""

    def fail(*_):
        raise AssertionError("not at its end after %d s" % LONGEST)

    signal.signal(signal.SIGALRM, fail)
    signal.alarm(0 if os.environ.get("HC_FULL") == "1" else LONGEST)
    test.addCleanup(signal.alarm, 0)


def listens(port):
    """Whether somebody listens on a port, asked of the kernel and not by connecting."""
    wanted = "0100007F:%04X 00000000:0000 0A" % port
    return wanted in pathlib.Path("/proc/net/tcp").read_text()


class Pipes(unittest.TestCase):
    result = None  # of the run

    def run(self, result=None):
        self.result = result
        return super().run(result)

    def failures(self):
        """The tracebacks of this test so far."""
        failed = self.result.failures + self.result.errors if self.result else []
        return [trace for test, trace in failed if test is self]

    def setUp(self):
        end_when_hung(self)
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.environment = dict(os.environ, HC_DATA=DATA)
        # A Python script that says no more than python3 is for the same.
        links = tempfile.TemporaryDirectory()
        self.addCleanup(links.cleanup)
        os.symlink(PYTHON, links.name + "/python3")
        self.environment["PATH"] = "{2}:{0}/bin:{0}/tests/programs:{1}".format(
            BUILD, os.environ["PATH"], links.name
        )
        self.environment.pop("DISPLAY", None)

    def start(self, command, **options):
        options = dict(dict(stdin=-3, stdout=-1, stderr=-1), **options)
        process = subprocess.Popen(
            ["bash", "-o", "pipefail", "-c", command],
            cwd=self.folder.name,
            env=self.environment,
            start_new_session=True,
            **options,
        )
        self.addCleanup(self.end, process)
        return process

    def end(self, process):
        """Ends a process that was started; of a failed test, prints what it logged last."""
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        _, log = process.communicate()
        failures = self.failures()
        if log and failures:  # the reason first: who reads a long log may have its beginning alone
            print("\n".join([each[-1000:] for each in failures]), flush=True)
            print("… " + log[-3000:].decode(errors="replace"), flush=True)

    def shell(self, command, status=0, data=b""):
        process = self.start(command, stdin=-1)
        out, err = process.communicate(data, timeout=WATCHDOG)
        self.assertEqual(process.returncode, status, (command, out[-3000:], err[-3000:]))
        self.err = err.decode()
        return out.decode(errors="replace")

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def write(self, name, data, mode=0o644):
        """Makes a file of text or bytes, or replaces one, which a reader never finds incomplete."""
        path = pathlib.Path(self.path(name))
        new = path.with_name(path.name + ".new")
        new.write_bytes(data if isinstance(data, bytes) else data.encode())
        new.chmod(mode)
        new.rename(path)

    def read(self, name):
        """The text of a file so far; "" before it is there."""
        path = pathlib.Path(self.path(name))
        return path.read_text(encoding="utf8") if path.exists() else ""

    def recorded(self, name):
        """The messages in text of a file so far."""
        return messages_of(self.read(name))

    def rows(self, name):
        return [row for message in self.recorded(name) for row in message.rows]

    def read_bytes(self, name):
        return pathlib.Path(self.path(name)).read_bytes()

    @staticmethod
    def catches_term(pid):
        text = pathlib.Path("/proc/%d/status" % pid).read_text()
        return int(re.search(r"SigCgt:\t([0-9a-f]+)", text)[1], 16) >> (signal.SIGTERM - 1) & 1

    def write_recording(self):
        """Ten positions, 20 ms apart, of two senders; one lost."""
        lines = []
        for i in range(10):
            lines.append(
                "1 7 0 %d 8 %d 10390 0 3 1 1\n%d 0 0\n" % (i, 10**18 + i * 20_000_000, i)
            )
            if i != 4:
                lines.append(
                    "1 8 0 %d 8 %d 120190 0 0 1 1\n%d\n" % (i, 10**18 + i * 20_000_000, i)
                )
        self.write("r.mtp", "".join(lines))
