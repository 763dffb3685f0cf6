# SPDX-License-Identifier: Apache-2.0
"""Graphs that run, as tests see them: what hc run prints, and what is asked of it."""

import contextlib
import json
import os
import re
import signal
import socket
import threading
import time

from harness import DATA, Pipes, WATCHDOG, wait_until

# Its modules continue until they are stopped.
GRAPH = (
    """
[modules.camera]
parameters = { source = "%s/HappyFish.jpg", loop = true, rate = 50, width = 80, height = 60 }
[modules.brightness]
[[modules.brightness.inputs.image]]
from = "camera.left"
"""
    % DATA
)
# A task with the focus, and a way for stops.
STOPPABLE = """
[modes]
look = 1
[workspace]
module = "workspace"
[modules.workspace]
inputs.bids = "looking.bid"
inputs.stop = "unix-listen:stop"
[modules.looking]
program = "bidder"
mode = "look"
"""


class Messages:
    """Messages of strings, as they come from a stream."""

    def __init__(self, connection):
        connection.settimeout(WATCHDOG)
        self.connection = connection
        self.file = connection.makefile("rb")

    def close(self):
        self.file.close()
        self.connection.close()

    def next(self):
        """Its src, and its rows without the spaces at their ends."""
        header = [int(word) for word in self.file.readline().split()]
        width, height = header[9:11]
        text = self.file.read(width * height).decode()
        self.file.readline()
        rows = [text[i : i + width].rstrip() for i in range(0, len(text), width or 1)]
        return header[1], rows


class Graphs(Pipes):
    def write_graph(self, text):
        self.write("g.new", "version = 1\n" + text)
        os.rename(self.path("g.new"), self.path("g.toml"))  # as editors do

    def run_graph(self, options="", last="brightness: started"):
        process = self.start("exec hc run g.toml " + options)
        self.await_lines(process, last)
        return process

    def listed(self):
        """What hc ps prints, also if a graph of another test does not answer."""
        return self.shell("hc ps || true")

    def hc(self, words, status=0):
        """What a verb of hc says, and where it is to fail, why."""
        out = self.shell("exec hc " + words, status)
        return out if status == 0 else self.err

    def running_graph(self, text=GRAPH, options="", last="brightness: started"):
        """A graph that runs; that it ends well, if it has not before, is checked at the end."""
        self.write_graph(text)
        process = self.run_graph(options, last)
        self.addCleanup(self.end_well, process)
        return process

    def end_well(self, process):
        if process.poll() is None and not self.failures():
            self.stop(process)

    def run_named(self, name, text=GRAPH, last="brightness: started"):
        """A running_graph() with a name that no other test has."""
        name = "%s_%d" % (name, os.getpid())
        return name, self.running_graph(text, "--as " + name, last)

    def await_lines(self, process, last):
        lines = []
        watchdog = threading.Timer(WATCHDOG, lambda: os.killpg(process.pid, signal.SIGKILL))
        watchdog.start()
        try:
            while not lines or not re.search(last, lines[-1]):
                line = process.stderr.readline().decode()
                self.assertNotEqual(line, "", lines)
                lines.append(line.rstrip("\n"))
        finally:
            watchdog.cancel()
        return lines

    def observe(self, process, name="g"):
        connection = socket.socket(socket.AF_UNIX)
        try:
            connection.connect("\0hypercolumn.%s.%d" % (name, process.pid))
        except OSError:
            connection.close()
            raise
        self.addCleanup(connection.close)
        return Messages(connection)

    def observed(self, process, name="g"):
        """As observe(), as soon as the graph can be."""

        def connected():
            self.assertIsNone(process.poll(), self.read("errors"))
            try:
                return self.observe(process, name)
            except OSError:
                return None

        return wait_until(connected)

    def state(self, messages, condition=lambda state: True):
        """The first state that is as wanted."""
        end = time.monotonic() + WATCHDOG
        while time.monotonic() < end:
            src, rows = messages.next()
            if src == 1 and condition(state := json.loads(rows[0])):
                return state
        self.fail("no state is as wanted; the last: %s" % rows)

    def state_of(self, process, name="g"):
        """Its state now."""
        with contextlib.closing(self.observed(process, name)) as messages:
            return self.state(messages)

    def ask(self, process, *commands, name="g"):
        with socket.socket(socket.AF_UNIX) as listening, socket.socket(socket.AF_UNIX) as graph:
            place = "answer.%d" % process.pid
            listening.bind("\0" + place)
            listening.listen()
            listening.settimeout(WATCHDOG)
            graph.connect("\0hypercolumn.%s.%d.ask" % (name, process.pid))
            rows = ["reply unix:@" + place, *commands]
            width = max(map(len, rows))
            text = "".join(row.ljust(width) for row in rows)
            graph.sendall(b"1 0 0 0 8 0 60101 0 0 %d %d\n" % (width, len(rows)))
            graph.sendall(text.encode() + b"\n")
            connection, _ = listening.accept()
            with connection:
                return Messages(connection).next()[1]

    def stop(self, process, status=0):
        os.kill(process.pid, signal.SIGINT)
        out, err = process.communicate(timeout=WATCHDOG)
        self.assertEqual(process.returncode, status, err)
        return out.decode(), err.decode()

    @staticmethod
    def all_run(state):
        """Whether every module runs, also one that waits for the processor: of a whole head on a busy
        machine one does at any time."""
        runs = lambda each: each["status"] == "running" or each["detail"] == "busy"
        return all(map(runs, state["modules"]))

    @staticmethod
    def module(state, name):
        return next((each for each in state["modules"] if each["name"] == name), None)
