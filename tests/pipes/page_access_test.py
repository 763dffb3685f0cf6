#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Who may use the server of the page, and what is too much or too slow for it."""

import json
import os
import re
import resource
import ssl
import unittest

from harness import wait_until
from page import Page, TASKS
from web_socket import TEXT, Refused, connect, get


class Access(Page):
    def test_who_may_not_is_refused(self):
        self.serve()
        host = "127.0.0.1:%d" % self.port
        self.assertEqual(get(self.port, "/")[0], 401)
        self.assertEqual(get(self.port, "/?token=" + "0" * 32)[0], 401)
        # A name that somebody has pointed here, before anything else is looked at.
        for foreign in ("evil.example", "evil.example:%d" % self.port, "127.0.0.1:1", ""):
            self.assertEqual(get(self.port, "/?token=" + self.token, Host=foreign)[0], 421)
        cookie = self.session()
        status, head, _ = get(self.port, "/", Cookie=cookie)
        self.assertEqual(status, 200)
        self.assertIn("default-src 'none'", head)
        # A token counts once.
        self.assertEqual(get(self.port, "/?token=" + self.token)[0], 401)
        self.assertEqual(get(self.port, "/", Cookie=cookie[:-1] + "x")[0], 401)
        for path in (
            "/../../etc/passwd",
            "/%2e%2e/%2e%2e/etc/passwd",
            "/recordings/../../etc/passwd.mcap",
            "/recordings/a/..%2f..%2fx.mcap",
            "/recordings/%00.mcap",
            "/recordings/..mcap",
            "/nothing",
        ):
            self.assertIn(get(self.port, path, Cookie=cookie)[0], (400, 404), path)
        for path, fields, status in (
            ("/graph", {"Cookie": ""}, 401),
            ("/graph", {"Origin": "http://evil.example"}, 403),
            ("/graph", {"Origin": "null"}, 403),
            ("/graph", {"Origin": "https://" + host}, 403),
            ("/graph", {"Host": "evil.example"}, 421),
            ("/nothing", {}, 404),
            ("/streams/../graph", {}, 404),
        ):
            with self.assertRaises(Refused) as refused:
                self.socket(path, **{"cookie": cookie, **fields}) if "Cookie" not in fields else (
                    self.socket(path, "")
                )
            self.assertEqual(refused.exception.status, status, (path, fields))

    def test_the_url_that_is_valid_now_is_printed_again(self):
        process = self.serve()
        url = "http://127.0.0.1:%d/?token=" % self.port
        self.environment["HC_GRAPH"] = "g.%d" % process.pid
        self.assertEqual(self.shell("hc page"), "web: page: " + url + self.token + "\n")
        graph = self.socket("/graph", self.session())

        def next_token():
            printed = self.shell("hc page --of g.%d" % process.pid)
            token = printed.split(url)[1].strip()
            return token != self.token and token

        self.session(wait_until(next_token))
        self.assertEqual(self.command(graph, "notices")[0], "ok")
        self.shell("hc graph remove web")
        self.shell("hc page", 1)
        self.assertIn("hc graph add web web", self.err)
        self.stop(process)

    def invited(self, graph, right):
        """The cookie of a session that was invited."""
        answer = self.command(graph, "invite " + right)
        self.assertEqual(answer[0], "ok")
        return self.session(answer[1].split("token=")[1])

    def test_each_right_does_what_it_may(self):
        self.serve()
        operator = self.socket("/graph", self.session())
        self.assertEqual(json.loads(self.hear(operator, 3))["right"], "operate")
        driver, viewer = self.invited(operator, "drive"), self.invited(operator, "view")
        with self.assertRaises(Refused) as refused:
            self.socket("/drive", viewer)
        self.assertEqual(refused.exception.status, 403)
        self.assertIn("invite is followed", self.command(operator, "invite admin")[0])
        for_operators = (
            "set camera.rate=20",
            "restart camera",
            "stop",
            "add x /bin/true",
            "link camera.left file:x",
            "invite view",
            "invite operate",
            "record one camera.left",
            "record end",
            "record delete one",
            "notices",
            "nonsense",
        )
        for right, cookie, refused in (
            ("view", viewer, ("estop clear", *for_operators)),
            ("drive", driver, for_operators),
        ):
            graph = self.socket("/graph", cookie)
            self.assertEqual(json.loads(self.hear(graph, 3))["right"], right)
            for text in refused:
                needed = "drive" if text == "estop clear" else "operate"
                self.assertEqual(
                    self.command(graph, text),
                    ["this session may %s; that needs the right to %s" % (right, needed)],
                )
            self.assertIn("streams are at", self.command(graph, "observe camera.left")[0])
            self.order(graph, "estop")
        self.order(graph, "estop clear")
        self.socket("/drive", driver)
        # A secret is in no line that observers get.
        log = self.socket("/graph", viewer)
        self.command(log, "describe camera")
        self.assertNotIn("token=", self.hear(log, 1))

    def assert_too_big(self, socket, send):
        try:
            send()
            code = socket.code()[0]
        except (BrokenPipeError, ConnectionResetError):
            return  # it was closed while it was sent
        self.assertEqual(code, 1009)

    def test_what_is_too_much_or_too_slow_is_closed(self):
        self.serve()
        cookie = self.session()
        graph = self.socket("/graph", cookie)
        self.assert_too_big(graph, lambda: graph.send_frame(TEXT, b"a" * (1 << 20)))
        graph = self.socket("/graph", cookie)

        def send_fragments():
            graph.send_frame(TEXT, b"a", is_last=False)
            for _ in range(1 << 14):
                graph.send_frame(0, b"a" * 16, is_last=False)

        self.assert_too_big(graph, send_fragments)
        self.assertEqual(get(self.port, "/", Cookie="a" * 9000)[0], 431)
        with connect(self.port) as slow, slow.makefile("rb") as file:
            slow.sendall(b"GET / HTTP/1.1\r\nHost: ")
            self.assertEqual(file.read(), b"")  # closed after 5 s
        with connect(self.port) as other, other.makefile("rb") as file:
            other.sendall(b"1 7 0 0 8 0 10390 1 3 1 1\n0.1 0.2 0.3\n\n\n")
            self.assertIn(b"400", file.read())
        self.assertEqual(get(self.port, "/", Cookie=cookie)[0], 200)

    def test_tls_is_1_3_and_its_cookie_secure(self):
        process = self.serve(TASKS.replace("port = 0", "port = 0\nparameters.tls = true"))
        modern = ssl.create_default_context()
        modern.check_hostname, modern.verify_mode = False, ssl.CERT_NONE
        status, head, _ = get(self.port, "/?token=" + self.token, modern)
        self.assertEqual(status, 303)
        self.assertIn("; Secure", head)
        cookie = re.search(r"Set-Cookie: ([^;]+);", head)[1]
        self.hear(self.socket("/graph", cookie, modern), 1)
        old = ssl.create_default_context()
        old.check_hostname, old.verify_mode = False, ssl.CERT_NONE
        old.maximum_version = ssl.TLSVersion.TLSv1_2
        with self.assertRaises((ssl.SSLError, ConnectionError)):
            get(self.port, "/", old)
        self.assertEqual(
            os.stat(self.path("settings/hypercolumn/page_key.pem")).st_mode & 0o777, 0o600
        )
        self.stop(process)


class Strangers(Page):
    def test_who_has_no_session_keeps_nobody_out(self):
        resource.setrlimit(resource.RLIMIT_NOFILE, (4096, 4096))
        self.serve()
        cookie = self.session()
        graph = self.socket("/graph", cookie)
        held = []
        self.addCleanup(lambda: [each.close() for each in held])

        def flood(half):
            for _ in range(650):
                held.append(connect(self.port))
                try:
                    held[-1].sendall(half)
                except (BrokenPipeError, ConnectionResetError):
                    pass  # it has been closed for a later one

        for half in (
            b"GET / HTTP/1.1\r\nHost: ",
            b"",
            b"\x16\x03\x01\x02\x00\x01",  # a handshake of TLS
            b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n",
        ):
            flood(half)
            for _ in range(20):
                self.assertEqual(get(self.port, "/", Cookie=cookie)[0], 200)
            self.hear(graph, 1)  # the session was not closed for them
        self.assertEqual(self.command(graph, "describe camera")[0], "ok")

    def test_who_answers_no_ping_is_closed(self):
        self.serve()
        cookie = self.session()
        graph, silent = self.socket("/graph", cookie), self.socket("/drive", cookie)
        self.hear(graph, 3, lambda text: '"driver":"other"' in text)
        # This client reads nothing of it, and so answers nothing, while the other one does.
        self.hear(graph, 3, lambda text: '"driver":null' in text)
        silent.close()


if __name__ == "__main__":
    unittest.main()
