# SPDX-License-Identifier: Apache-2.0
"""What comes out of the simulated neck, and what is sent into inputs of the head."""

import os
import re
import socket
import threading
import time

from harness import wait_until
from necks import STEP

MOVED = 1e-6  # less is the same angle [rad]


class Stream:
    """The messages of an output, also after its module was restarted: (time [ns], elements). The
    time is the sender's, or that of arrival here, where clocks are set."""

    def __init__(self, address, by_arrival):
        self.address, self.messages, self.is_over = address, [], threading.Event()
        self.by_arrival = by_arrival
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        while not self.is_over.wait(0.002):
            with socket.socket(socket.AF_UNIX) as connection:
                connection.settimeout(1)
                try:
                    connection.connect(self.address)
                    self.read(connection.makefile("rb"))
                except OSError:  # it is being started, or was killed
                    pass

    def read(self, file):
        while not self.is_over.is_set() and (line := file.readline()).endswith(b"\n"):
            header = [int(word) for word in line.split()]
            info, size = header[6], header[9] * header[10]
            is_string = info // 10000 == 6
            elements = file.read(size) if is_string else b""
            rest = [file.readline() for _ in range(1 if is_string else header[10])]
            if not all(row.endswith(b"\n") for row in rest):
                return
            stamp = time.time_ns() if self.by_arrival else header[5]
            self.messages.append((stamp, elements or b"".join(rest)))

    def wait_more(self, count):
        """Waits for so many more messages."""
        wanted = len(self.messages) + count
        wait_until(lambda: len(self.messages) >= wanted)

    def wait_until(self, moment):
        """Waits for a message of a time or later [ns]."""
        wait_until(lambda: self.messages and self.messages[-1][0] >= moment)

    def end(self):
        self.is_over.set()
        self.thread.join()


class Motion(Stream):
    """Where the unit truly is: what `head_unit.motion` says, by the unit's own time stamps."""

    def angles(self, begin=0):
        """(time [ns], tilt, pan [rad]) of messages from a number on."""
        rows = self.messages[begin:]
        return [(at, *map(float, row.split()[1:3])) for at, row in rows]

    def pan(self):
        return self.angles(-1)[0][2] if self.messages else 0.0

    def moves(self, begin=0):
        """When it had moved, against the message before each [ns]."""
        rows = self.angles(max(0, begin - 1))
        return [
            b[0]
            for a, b in zip(rows, rows[1:])
            if abs(a[1] - b[1]) > MOVED or abs(a[2] - b[2]) > MOVED
        ]

    def since(self, moment):
        """The number of the first message of a time [ns] or later."""
        number = len(self.messages)
        while number > 0 and self.messages[number - 1][0] >= moment:
            number -= 1
        return number

    def travelled(self, begin):
        """How far it was from where it was first, at most, since a time [rad]."""
        rows = self.angles(self.since(begin))
        return max((max(abs(r[1] - rows[0][1]), abs(r[2] - rows[0][2])) for r in rows), default=0)

    def turns(self, begin):
        """How often the pan's direction has changed since a time [ns]."""
        rows = self.angles(self.since(begin))
        ways = [b[2] > a[2] for a, b in zip(rows, rows[1:]) if abs(b[2] - a[2]) > MOVED]
        return sum(a != b for a, b in zip(ways, ways[1:]))

    def rests_at(self, moment, seconds=0.4):
        """Waits until it has rested for so long, after a moment [ns]; when it moved last [ns]."""
        pause = int(seconds * 1e9)

        def rests():
            if not self.messages or self.messages[-1][0] < moment + pause:
                return None
            moves = self.moves(self.since(moment))
            last = moves[-1] if moves else moment
            return last if self.messages[-1][0] >= last + pause else None

        return wait_until(rests)


class Focus(Stream):
    """The mode in focus, as the workspace says it."""

    def mode(self):
        """The number of the last."""
        return int(self.messages[-1][1]) if self.messages else None

    def modes(self, begin):
        """(time [ns], number of the mode) from a time on [ns]."""
        return [(at, int(row)) for at, row in list(self.messages) if at >= begin]

    def changes(self, begin):
        """(how long after a time [s], mode that came into focus then), of all changes since."""
        modes = self.modes(0)
        return [
            (round((b[0] - begin) / 1e9, 3), b[1])
            for a, b in zip(modes, modes[1:])
            if a[1] != b[1] and b[0] >= begin
        ]


class Line(Stream):
    """The words on the unit's line: what the driver has commanded."""

    def words(self, begin=0):
        """(time [ns], word), each when its end came."""
        found, rest = [], ""
        for at, piece in list(self.messages):
            rest += piece.decode("latin1")
            *whole, rest = re.split(r"(?<= )", rest)
            found += [(at, word.strip()) for word in whole]
        return [each for each in found if each[0] >= begin]

    def positions(self, begin):
        """When it was commanded to go somewhere, from a time on [ns]."""
        return [at for at, word in self.words(begin) if re.fullmatch(r"[pt]p-?\d+", word)]

    def tilts(self, begin, tilt):
        """When it was commanded to this tilt [rad]."""
        words = [(at, re.fullmatch(r"tp(-?\d+)", word)) for at, word in self.words(begin)]
        return [at for at, found in words if found and abs(int(found[1]) * STEP + tilt) < 0.01]


def message(info, rows, coord=0, mode=0, src=90, stamp=None, width=1, height=1):
    """A message in text. `stamp` None: now [ns]."""
    stamp = time.time_ns() if stamp is None else stamp
    text = "1 %d 0 0 8 %d %d %d %d %d %d\n%s\n"
    return (text % (src, stamp, info, mode, coord, width, height, rows)).encode()


def stick(left, down=0.0, src=90, stamp=None):
    return message(120190, "%g %g" % (left, down), src=src, stamp=stamp, width=2)


def bid(salience, mode, src=90, stamp=None):
    return message(120190, "%g" % salience, mode=mode, src=src, stamp=stamp)


def stop(value, src=90):
    return message(120100, "%d" % value, src=src)


def rotation(pan, tilt=0.0, coord=14, mode=0, src=90, stamp=None):
    return message(20390, "0 %r %r" % (tilt, pan), coord, mode, src, stamp)


def run_delay(pid):
    """How long threads of a process waited for a processor so far [ns]; but for those that yield
    to all others. 0 where the process is gone."""
    total = 0
    try:
        for thread in os.listdir("/proc/%d/task" % pid):
            folder = "/proc/%d/task/%s/" % (pid, thread)
            with open(folder + "stat", encoding="latin1") as file:
                nice = int(file.read().rsplit(") ", 1)[1].split()[16])
            if nice <= 0:
                with open(folder + "schedstat", encoding="latin1") as file:
                    total += int(file.read().split()[1])
    except OSError:
        pass
    return total
