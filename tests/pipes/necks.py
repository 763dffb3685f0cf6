# SPDX-License-Identifier: Apache-2.0
"""A driver and a simulated unit, and what both say, for the tests of the neck."""

import math
import os
import socket
import threading
import time

from harness import BUILD, Pipes, wait_until

STEP = math.radians(185.1428 / 3600)  # of the unit [rad]
PROGRAMS = os.path.join(BUILD, "libexec/hypercolumn/")


class Reader:
    """Messages in text that come out of a link, as they come: (time, coord, rows)."""

    def __init__(self, name):
        self.socket = connected(name)
        self.messages = []
        threading.Thread(target=self.read, daemon=True).start()

    def read(self):
        stream = self.socket.makefile()
        while line := self.line(stream):
            header = [int(word) for word in line.split()]
            rows = [[float(w) for w in self.line(stream).split()] for _ in range(header[10])]
            if all(rows):
                self.messages.append((header[5], header[8], rows))

    @staticmethod
    def line(stream):
        try:
            return stream.readline()
        except ConnectionResetError:  # the writer was killed
            return ""

    def wait(self, count=1):
        """The message that is so many behind those that have come."""
        end = len(self.messages) + count
        wait_until(lambda: len(self.messages) >= end)
        return self.messages[end - 1]

    def angles(self):
        """Tilt and pan of all messages."""
        return [rows[0][1:] for _, _, rows in self.messages]


def connected(name):
    link = socket.socket(socket.AF_UNIX)

    def tries():
        try:
            link.connect("\0" + name)
            return True
        except ConnectionRefusedError:
            return False

    wait_until(tries)
    return link


class Program:
    """A module that runs: its lines, and a link to tell it."""

    def __init__(self, process, control):
        self.process, self.lines = process, []
        threading.Thread(target=self.read, daemon=True).start()
        self.control = connected(control)

    def read(self):
        for line in self.process.stderr:
            self.lines.append(line.decode().rstrip())

    def set(self, assignment):
        text = "set " + assignment
        self.control.sendall(b"1 1 0 0 8 0 60100 0 0 %d 1\n%s\n" % (len(text), text.encode()))

    def wait_line(self, part, begin=0):
        wait_until(lambda: any(part in line for line in self.lines[begin:]))


class Necks(Pipes):
    """Tests that start both, or either."""

    def setUp(self):
        super().setUp()
        self.environment["TMPDIR"] = self.folder.name
        self.name = os.path.basename(self.folder.name) + "-"

    def start_fake(self, words="", device=None):
        """Starts the unit; `device` is a file that its name goes to, else the driver reads it."""
        name = self.name
        device = "file:" + device if device else "unix-listen:@%sdevice?stay=1&keep=latest" % name
        self.fake = Program(
            self.start(
                "exec %sfake_pan_tilt --control unix-listen:@%scontrol_fake"
                " --out 'device=%s' --out 'motion=unix-listen:@%smotion?stay=1&keep=latest' %s"
                % (PROGRAMS, name, device, name, words)
            ),
            name + "control_fake",
        )
        self.motion = Reader(name + "motion")

    def start_neck(self, words="", age=10, device=None):
        """Starts the driver; `device` is its name, else the fake sends it."""
        name = self.name
        link = "--in 'device=unix:@%sdevice?reconnect=600'" % name
        device = link if device is None else "--device " + device
        self.neck = Program(
            self.start(
                "exec %span_tilt --age %g --control unix-listen:@%scontrol_neck"
                " %s --in command=unix-listen:@%scommand"
                " --out 'gaze=unix-listen:@%sgaze?stay=1&keep=latest'"
                " --out 'pose=unix-listen:@%spose?stay=1&keep=latest' %s"
                % (PROGRAMS, age, name, device, name, name, name, words)
            ),
            name + "control_neck",
        )
        self.gaze = Reader(name + "gaze")
        self.pose = Reader(name + "pose")
        self.commands = connected(name + "command")

    def start_ready(self, words="", age=10):
        self.start_neck(words, age)
        self.gaze.wait()
        self.motion.wait()

    def start_both(self, neck="", fake=""):
        self.start_fake(fake)
        self.start_ready(neck)

    def command(self, pan, tilt, seconds=0.0, timed=True):
        """Commands a gaze as one who lives so many seconds later."""
        stamp = time.time_ns() + int(seconds * 1e9) if timed else 0
        row = "0 %r %r" % (tilt, pan)
        self.commands.sendall(b"1 1 0 0 8 %d 20390 0 13 1 1\n%s\n" % (stamp, row.encode()))

    def drive(self, pan, condition):
        """Commands a pan again and again until something is so."""
        wait_until(lambda: self.command(pan, 0.0) or condition(self.motion.angles()[-1][1]))

    def go(self, pan, tilt=0.0):
        """Commands a gaze until the unit is there: not once alone, since what was commanded is
        forgotten when the unit answers too late, as on a busy machine."""
        commanded = 0

        def is_there():
            nonlocal commanded
            if time.monotonic() > commanded + 1:
                self.command(pan, tilt)
                commanded = time.monotonic()
            now_tilt, now_pan = self.motion.angles()[-1]
            return abs(now_pan - pan) < STEP and abs(now_tilt - tilt) < STEP

        wait_until(is_there)

    def answers_again(self, begin, most):
        """Waits for it, and that no more was said than so many lines for each time."""
        self.neck.wait_line("reconnected", begin)
        self.gaze.wait(3)
        said = self.neck.lines[begin:]
        times = sum("reconnected" in line for line in said)
        self.assertLessEqual(len(said), most * times, said)
