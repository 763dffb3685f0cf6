# SPDX-License-Identifier: Apache-2.0
"""What the tests of the server of the page share: a graph with a page, and its WebSockets."""

import re

from graphs import GRAPH, Graphs
from harness import wait_until
from web_socket import BINARY, WebSocket, get

TASKS = (
    GRAPH
    + """
[modes]
look = 1
[workspace]
module = "workspace"
[modules.workspace]
parameters.person_expiry = 1
inputs.bids = "look.bid"
inputs.person = "web.bid"
inputs.stop = "web.stop"
[modules.web]
parameters.port = 0
inputs.stopped = { from = "workspace.stopped", rate = 20 }
[modules.look]
program = "gaze"
mode = "look"
inputs.stick = "web.stick"
[frames.robot]
parent = "world"
translation = [0.0, 0.0, 1.2]
[frames.head]
parent = "robot"
[frames.left_eye]
parent = "head"
translation = [0.0, 0.05, 0.0]
[frames.right_eye]
parent = "head"
translation = [0.0, -0.05, 0.0]
"""
)
STICK = b"1 1 0 0 8 0 120190 0 0 2 1\n"
ALIVE = b"1 0 0 0 8 0 120190 0 0 1 1\n"


def number(src, value, mode=0):
    """A message of one number."""
    return b"1 %d 0 0 8 0 120190 %d 0 1 1\n%g\n" % (src, mode, value)


def message(data):
    """Header and elements of a message in binary."""
    line, elements = data.split(b"\n", 1)
    return [int(word) for word in line.split()], elements[:-1]


class Page(Graphs):
    def setUp(self):
        super().setUp()
        self.environment["XDG_CONFIG_HOME"] = self.path("settings")

    def serve(self, graph=TASKS, options="", before=""):
        """Runs a graph; gives the process, and has the port and a token of its page."""
        self.write_graph(graph)
        process = self.start(before + "exec hc run g.toml " + options)
        line = self.await_lines(process, "web: page: ")[-1]
        self.port, self.token = re.search(r":(\d+)/\?token=(\w+)", line).groups()
        self.port = int(self.port)
        return process

    def session(self, token=None, context=None):
        status, head, _ = get(self.port, "/?token=" + (token or self.token), context)
        self.assertEqual(status, 303, head)
        return re.search(r"Set-Cookie: ([^;]+);", head)[1]

    def socket(self, path, cookie, context=None, **fields):
        opened = WebSocket(self.port, path, cookie, context, **fields)
        self.addCleanup(opened.close)
        return opened

    def next(self, graph):
        """The next src and string; keeps the last session, which is sent only when it changes."""
        kind, data = graph.next()
        self.assertEqual(kind, BINARY, data)
        header, elements = message(data)
        width = header[9]
        rows = [elements[i : i + width] for i in range(0, len(elements), width or 1)]
        rows = [row.decode().rstrip() for row in rows]
        if header[1] == 3:
            graph.session = rows[0]
        return header[1], rows

    def hear(self, graph, src, condition=lambda text: True):
        """The next string of a src that is as wanted; of sessions the last one, if it is."""
        last = getattr(graph, "session", None)
        if src == 3 and last and condition(last):
            return last
        while True:
            said, rows = self.next(graph)
            text = "\n".join(rows)
            if said == src and condition(text):
                return text

    def order(self, graph, text):
        """Stops the robot or clears that, and again until the workspace confirms it in time."""

        def is_confirmed():
            rows = self.command(graph, text)
            late = re.match("(stop NOT confirmed|NOT cleared): the workspace ", rows[0])
            self.assertTrue(rows == ["ok"] or late, rows)
            return rows == ["ok"]

        wait_until(is_confirmed)

    def command(self, graph, text):
        """The rows of an answer."""
        graph.send(text)
        while True:
            src, rows = self.next(graph)
            if src == 4:
                return rows
