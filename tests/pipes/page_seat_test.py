#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The stop and the driver's seat of the page."""

import contextlib
import json
import os
import signal
import unittest

from page import ALIVE, Page, STICK, TASKS, message, number
from web_socket import BINARY, TEXT


class Stop(Page):
    def pid(self, graph, name):
        """The process of a module, once it has one."""
        pid = 0
        while pid == 0:
            modules = json.loads(self.hear(graph, 1))["modules"]
            pid = next(module["pid"] for module in modules if module["name"] == name)
        return pid

    def freeze(self, graph, name):
        """Stops a process for a while; gives its number."""
        pid = self.pid(graph, name)
        os.kill(pid, signal.SIGSTOP)

        def thaw():
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGCONT)

        self.addCleanup(thaw)
        return pid

    def words(self, cookie):
        """A generator of what `web` sends at its output stop."""
        stream = self.socket("/streams/web.stop?as=raw", cookie)
        while True:
            kind, data = stream.next()
            if kind == BINARY:
                header, elements = message(data)
                yield int(elements) if header[6] % 10 == 0 else elements[0]
                stream.send("ok")

    def test_who_takes_nothing_holds_no_stop_up(self):
        process = self.serve()
        cookie = self.session()
        graph, drive = self.socket("/graph", cookie), self.socket("/drive", cookie)
        self.hear(graph, 3, lambda text: '"stopped":false' in text)
        self.freeze(graph, "look")
        for _ in range(5000):  # more than any link has room for
            drive.send_frame(BINARY, STICK + b"0.1 0.1\n")
            drive.send_frame(BINARY, number(5, 1, 1))
        self.order(graph, "estop")
        self.hear(graph, 3, lambda text: '"stopped":true' in text)
        self.stop(process)

    def test_a_stop_that_is_not_confirmed_is_no_ok(self):
        process = self.serve()
        graph = self.socket("/graph", self.session())
        self.hear(graph, 3, lambda text: '"stopped":false' in text)
        pid = self.freeze(graph, "workspace")
        # The last report before it was frozen may still be on its way.
        self.assertIn("stop NOT confirmed: the workspace", self.command(graph, "estop")[0])
        self.hear(graph, 3, lambda text: '"stopped":null' in text)
        # Answers of other commands do not wait for it, and say whose they are.
        graph.send("estop"), graph.send("describe camera")
        answers = []
        while len(answers) < 2:
            header, _ = message(graph.next()[1])
            if header[1] == 4:
                answers.append(header[3])
        self.assertEqual(sorted(answers), [1, 2])
        os.kill(pid, signal.SIGCONT)  # the order was repeated meanwhile
        self.hear(graph, 3, lambda text: '"stopped":true' in text)
        os.kill(pid, signal.SIGSTOP)
        # What it said before it was frozen may still be on its way.
        self.assertIn("NOT cleared: the workspace", self.command(graph, "estop clear")[0])
        os.kill(pid, signal.SIGCONT)
        self.stop(process)

    def test_nothing_is_linked(self):
        stopped = 'inputs.stopped = { from = "workspace.stopped", rate = 20 }\n'
        for missing, words in (
            ('inputs.stop = "web.stop"\n', "nothing is linked to web.stop"),
            (stopped, "nothing comes to web.stopped"),
        ):
            self.assertIn(missing, TASKS)
            process = self.serve(TASKS.replace(missing, ""))
            graph = self.socket("/graph", self.session())
            for order in ("estop", "estop clear"):
                answer = self.command(graph, order)
                self.assertRegex(answer[0], "NOT (confirmed|cleared): " + words)
            self.stop(process)

    def test_a_page_guards_while_it_is_open(self):
        process = self.serve()
        cookie = self.session()
        graph = self.socket("/graph", cookie)
        words = self.words(cookie)
        self.assertEqual([next(words) for _ in range(20)], [0] * 20)
        self.order(graph, "estop")
        while next(words) != 1:
            pass
        self.assertEqual([next(words) for _ in range(5)], [1] * 5)
        self.order(graph, "estop clear")
        while (word := next(words)) != 2:
            self.assertEqual(word, 1)
        while (word := next(words)) == 2:  # until the workspace has confirmed it
            pass
        self.assertEqual([word] + [next(words) for _ in range(5)], [0] * 6)
        graph.close()
        while (word := next(words)) != 3:
            self.assertEqual(word, 0)
        again = self.socket("/graph", cookie)
        # It is said several times, of which a page that looks late gets the last.
        while (word := next(words)) == 3:
            pass
        self.assertEqual(word, 0)
        again.close()
        self.stop(process)


class Seat(Page):
    def test_one_drives_and_another_may_take_the_seat(self):
        process = self.serve()
        cookie = self.session()
        first = self.socket("/drive", cookie)
        self.assertEqual(self.socket("/drive", cookie).code(), (4409, "another page drives"))
        graph = self.socket("/graph", cookie)
        self.hear(graph, 3, lambda text: '"driver":"other"' in text)
        second = self.socket("/drive?take=1", cookie)
        self.assertEqual(first.code()[0], 4409)
        for wrong in (
            b"no message",
            number(5, 2, 1),
            number(5, 1, 99),  # no mode of the graph
            number(9, 0),
            ALIVE + b"0\n" + ALIVE + b"0\n",
        ):
            second.send_frame(BINARY, wrong)
            self.assertEqual(second.code()[0], 1007, wrong)
            second = self.socket("/drive", cookie)
        # What points into an image that is long gone is refused with words, and not obeyed.
        second.send_frame(BINARY, b"1 3 0 0 8 1 10390 0 7 1 1\n1 1 0\n")
        kind, words = second.next()
        self.assertEqual(kind, TEXT)
        self.assertIn(b"is not current", words)
        second.close()
        self.hear(graph, 3, lambda text: '"driver":null' in text)
        self.stop(process)


if __name__ == "__main__":
    unittest.main()
