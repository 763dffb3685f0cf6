# SPDX-License-Identifier: Apache-2.0
"""The server of the page, as any client sees it: who may do what, streams, the seat, recordings."""

import contextlib
import ctypes
import json
import os
import pathlib
import re
import resource
import signal
import ssl
import struct
import unittest

from graphs import GRAPH, Graphs
from harness import wait_until
from web_socket import BINARY, CLOSE, TEXT, Refused, WebSocket, connect, get, read_head

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


@contextlib.contextmanager
def held(threads):
    """Holds threads of other processes, as a disk that hangs would."""
    seize, interrupt, detach, all_children = 0x4206, 0x4207, 17, 0x40000000
    libc = ctypes.CDLL(None, use_errno=True)
    with contextlib.ExitStack() as stack:
        for thread in threads:
            if libc.ptrace(seize, thread, 0, 0) != 0:
                raise unittest.SkipTest("ptrace: " + os.strerror(ctypes.get_errno()))
            stack.callback(libc.ptrace, detach, thread, 0, 0)
            libc.ptrace(interrupt, thread, 0, 0)
            os.waitpid(thread, all_children)
        yield


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

    def command(self, graph, text):
        """The rows of an answer."""
        graph.send(text)
        while True:
            src, rows = self.next(graph)
            if src == 4:
                return rows


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
            self.assertEqual(self.command(graph, "estop"), ["ok"])
        self.assertEqual(self.command(graph, "estop clear"), ["ok"])
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


class Graph(Page):
    def test_state_log_and_commands(self):
        process = self.serve()
        graph = self.socket("/graph", self.session())
        session = json.loads(self.hear(graph, 3, lambda text: '"bid"' in text))
        self.assertEqual(session["web"], "web")
        self.assertEqual(set(session["drives"]), {"bid", "stick"})
        self.assertIn("robot 2 world 0 0 1.2", session["frames"])
        state = json.loads(self.hear(graph, 1))
        self.assertIn("camera", [module["name"] for module in state["modules"]])
        answer = self.command(graph, "describe camera")
        self.assertEqual(json.loads(answer[1])["name"], "camera")
        self.assertIn("did you mean", self.command(graph, "describe camra")[0])
        self.assertEqual(self.command(graph, "set camera.rate=20"), ["ok"])
        self.hear(
            graph,
            1,
            lambda text: any(
                module["name"] == "camera" and module["parameters"].get("rate") == "20"
                for module in json.loads(text)["modules"]
            ),
        )
        self.assertIn("no parameter", self.command(graph, "set camera.rat=20")[0])
        self.assertEqual(self.command(graph, "restart brightness"), ["ok"])
        self.hear(
            graph,
            2,
            lambda text: json.loads(text)
            == {"module": "brightness", "level": "info", "text": "started"},
        )
        graph.send("stop")
        self.assertEqual(graph.code()[0], 1001)
        process.communicate()


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
        self.assertEqual(self.command(graph, "estop"), ["ok"])
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
        self.assertEqual(self.command(graph, "estop"), ["ok"])
        while next(words) != 1:
            pass
        self.assertEqual([next(words) for _ in range(5)], [1] * 5)
        self.assertEqual(self.command(graph, "estop clear"), ["ok"])
        while (word := next(words)) != 2:
            self.assertEqual(word, 1)
        while (word := next(words)) == 2:  # until the workspace has confirmed it
            pass
        self.assertEqual([word] + [next(words) for _ in range(5)], [0] * 6)
        graph.close()
        while (word := next(words)) != 3:
            self.assertEqual(word, 0)
        self.assertEqual([next(words), next(words)], [3, 3])
        again = self.socket("/graph", cookie)
        self.assertEqual(next(words), 0)
        again.close()
        self.stop(process)


class Streams(Page):
    def test_an_image_comes_as_it_is_wanted(self):
        process = self.serve()
        cookie = self.session()
        raw = self.socket("/streams/brightness.image", cookie)
        kind, header = raw.next()
        self.assertEqual((kind, header.split()[9:]), (TEXT, [b"80", b"60"]))
        header, elements = message(raw.next()[1])
        self.assertEqual((header[9:], len(elements)), ([80, 60], 80 * 60 * 3))
        jpeg = self.socket("/streams/camera.left?as=jpeg&width=40", cookie)
        self.assertEqual(jpeg.next()[1].split()[9:], [b"80", b"60"])
        header, elements = message(jpeg.next()[1])
        self.assertEqual((header[6], header[9:]), (30303, [40, 30]))
        self.assertEqual(elements.split(b"\n", 1)[1][:2], b"\xff\xd8")
        vp8 = self.socket("/streams/camera.left?as=vp8", cookie)
        vp8.next()
        for is_key in (True, False):
            kind, data = vp8.next()
            header, frame = message(data)
            self.assertEqual((header[6], header[10]), (120101, 1))
            self.assertEqual(not frame[0] & 1, is_key)
            vp8.send("ok")
        # Who missed images needs no key frame: the next one is coded after the last it was sent.
        for _ in range(20):
            self.assertIn(raw.next()[0], (TEXT, BINARY))
            raw.send("ok")
        sequences = [header[3]]
        for _ in range(3):
            kind, data = vp8.next()
            while kind == TEXT:
                kind, data = vp8.next()
            header, frame = message(data)
            self.assertTrue(frame[0] & 1)
            sequences.append(header[3])
            vp8.send("ok")
        self.assertGreater(max(b - a for a, b in zip(sequences, sequences[1:])), 2)
        table = self.socket("/streams/brightness.mean?as=jpeg&width=10", cookie)
        table.next()
        self.assertEqual(message(table.next()[1])[0][6], 120191)
        self.assertIn("did you mean", self.socket("/streams/camera.lef", cookie).code()[1])
        self.assertEqual(self.socket("/streams/camera.lef", cookie).code()[0], 4404)
        self.assertEqual(self.socket("/streams/camera.left?as=png", cookie).code()[0], 1008)
        self.stop(process)

    def test_who_does_not_answer_gets_two_and_then_the_newest(self):
        process = self.serve()
        cookie = self.session()
        stream = self.socket("/streams/brightness.mean", cookie)
        other = self.socket("/streams/brightness.mean", cookie)

        def sequence(socket):
            kind, data = socket.next()
            while kind == TEXT:
                kind, data = socket.next()
            self.assertEqual(kind, BINARY, data)
            return message(data)[0][3]

        first = [sequence(stream), sequence(stream)]
        for _ in range(50):  # meanwhile another gets on
            newest = sequence(other)
            other.send("ok")
        stream.send("ok")
        self.assertGreater(sequence(stream), newest - 3)
        self.assertLess(first[1], newest - 30)
        stream.send("rate=nonsense")
        self.assertEqual(stream.code()[0], 1008)
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


class Recordings(Page):
    def test_a_download_lasts_as_long_as_it_takes_and_no_link_ends_the_server(self):
        self.serve()
        cookie = self.session()
        folder = pathlib.Path(self.path("recordings"))
        folder.mkdir()
        self.shell("hc send 1 2 | hc record recordings/one.mcap")
        size = 40 << 20
        os.truncate(folder / "one.mcap", size)  # its end is lost, as if its writer had been killed
        (folder / "two.mcap").symlink_to("nowhere")
        (folder / "four.mcap").symlink_to("four.mcap")
        (folder / "five.mcap").mkdir()
        os.mkfifo(folder / "three.mcap")
        graph = self.socket("/graph", cookie)
        listed = json.loads(get(self.port, "/recordings", Cookie=cookie)[2])
        self.assertEqual(listed, [{"name": "one", "bytes": size, "streams": ["messages"]}])
        for name in ("two", "three", "four", "five", "six"):
            path = "/recordings/%s.mcap" % name
            self.assertEqual(get(self.port, path, Cookie=cookie)[0], 404)
        # Two at the same time, of which one waits for the other.
        request = "GET /recordings/one.mcap HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nCookie: %s\r\n\r\n"
        request = (request % (self.port, cookie)).encode()
        with connect(self.port) as first, first.makefile("rb") as file:
            first.sendall(request)
            head = read_head(file)
            self.assertIn("Content-Length: %d\r\n" % size, head)
            self.assertEqual(len(get(self.port, "/recordings/one.mcap", Cookie=cookie)[2]), size)
            self.assertEqual(len(file.read(size)), size)
        for name in ("one", "two"):
            said = self.command(graph, "record %s camera.left" % name)
            self.assertIn("already", said[0])
        for command in (
            "record a/b camera.left",
            "record new",
            "record new camera",
            "record new ../x.y",
        ):
            self.assertNotEqual(self.command(graph, command), ["ok"], command)
        self.assertEqual((folder / "one.mcap").stat().st_size, size)
        self.assertEqual(len(os.listdir(folder)), 5)  # nothing was left there

    def record(self, graph):
        """Begins a recording, of which something is on the disk then."""
        self.assertEqual(self.command(graph, "record one camera.left brightness.mean"), ["ok"])
        path = pathlib.Path(self.path("recordings/one.mcap"))
        wait_until(lambda: path.stat().st_size > 20000)
        return path

    def pid(self, graph):
        """Of the server."""
        state = json.loads(self.hear(graph, 1))
        return next(each["pid"] for each in state["modules"] if each["name"] == "web")

    def threads(self, graph):
        return {int(each) for each in os.listdir("/proc/%d/task" % self.pid(graph))}

    def test_a_disk_that_hangs_holds_no_page_up(self):
        self.serve()
        graph = self.socket("/graph", self.session())
        before = self.threads(graph)
        self.record(graph)
        with held(self.threads(graph) - before):
            graph.send("record end")
            self.assertGreater(len(self.command(graph, "describe camera")), 1)
            self.assertIn("being started or ended", self.command(graph, "record end")[0])
            self.assertIn(
                "being started or ended", self.command(graph, "record two camera.left")[0]
            )
            self.hear(graph, 3, lambda text: json.loads(text)["recording"]["name"] == "one")
        self.assertEqual(self.hear(graph, 4), "ok")
        self.hear(graph, 3, lambda text: json.loads(text)["recording"] is None)

    def test_where_no_thread_is_to_be_had_it_refuses_what_waits_for_a_disk(self):
        self.serve()
        cookie = self.session()
        graph = self.socket("/graph", cookie)
        self.record(graph)
        with connect(self.port) as kept, kept.makefile("rb") as file:

            def status(path="/recordings", more=""):
                fields = "Host: 127.0.0.1:%d\r\nCookie: %s\r\n" % (self.port, cookie)
                kept.sendall(("GET %s HTTP/1.1\r\n%s\r\n" % (path, fields + more)).encode())
                head = read_head(file)
                file.read(int((re.search(r"Content-Length: (\d+)", head) or [0, 0])[1]))
                return head.split()[1]

            self.assertEqual(status(), "200")
            pid = self.pid(graph)
            before = resource.prlimit(pid, resource.RLIMIT_NOFILE)
            resource.prlimit(pid, resource.RLIMIT_NOFILE, (3, before[1]))  # no descriptor, either
            self.assertEqual(status(), "503")
            self.assertIn("too busy", self.command(graph, "record end")[0])
            # A stream that cannot begin ends its connection alone.
            origin = "Origin: http://127.0.0.1:%d\r\n" % self.port
            handshake = "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
            handshake += "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
            self.assertEqual(status("/streams/camera.left", origin + handshake), "101")
            self.assertEqual(file.read(), b"")
            resource.prlimit(pid, resource.RLIMIT_NOFILE, before)
        self.assertEqual(self.command(graph, "record end"), ["ok"])
        self.hear(graph, 3, lambda text: json.loads(text)["recording"] is None)

    def test_a_full_disk_ends_the_recording_and_keeps_it(self):
        self.serve(before="trap '' XFSZ; ")
        graph = self.socket("/graph", self.session())
        path = self.record(graph)
        # As on a full disk: a write that fails.
        resource.prlimit(self.pid(graph), resource.RLIMIT_FSIZE, (path.stat().st_size + 5000,) * 2)
        self.hear(graph, 2, lambda text: "the file keeps all before" in text)
        self.hear(graph, 3, lambda text: json.loads(text)["recording"] is None)
        self.assertRegex(self.shell("hc info recordings/one.mcap"), r"camera\.left +[1-9]")

    def test_what_is_recorded_is_listed_and_read_again(self):
        process = self.serve()
        cookie = self.session()
        graph = self.socket("/graph", cookie)
        self.record(graph)
        self.assertIn("already", self.command(graph, "record two camera.left")[0])
        self.hear(graph, 3, lambda text: json.loads(text)["recording"]["bytes"] > 9999)
        self.assertEqual(self.command(graph, "record end"), ["ok"])
        self.assertIn("already", self.command(graph, "record one camera.left")[0])
        self.assertIn("nothing", self.command(graph, "record end")[0])
        recordings = json.loads(get(self.port, "/recordings", Cookie=cookie)[2])
        self.assertEqual(recordings[0]["streams"], ["brightness.mean", "camera.left"])
        status, _, data = get(self.port, "/recordings/one.mcap", Cookie=cookie)
        self.write("copy.mcap", data)
        self.assertEqual(status, 200)
        out = self.shell("hc info copy.mcap")
        self.assertRegex(out, r"camera\.left +\d+ .* sensor_msgs/msg/CompressedImage\n")
        self.assertEqual(get(self.port, "/recordings/two.mcap", Cookie=cookie)[0], 404)
        self.stop(process)


class Any(Page):
    def test_any_graph_has_a_page(self):
        process = self.serve(GRAPH, "--page --quiet --set web.port=0")
        graph = self.socket("/graph", self.session())
        self.assertEqual(json.loads(self.hear(graph, 3))["stopped"], None)
        self.assertIn("no workspace", self.command(graph, "estop")[0])
        self.stop(process)

    def test_a_page_with_a_workspace_can_stop_it(self):
        workspace = GRAPH + '[workspace]\nmodule = "w"\n[modules.w]\nprogram = "workspace"\n'
        process = self.serve(workspace, "--page --set web.port=0")
        graph = self.socket("/graph", self.session())
        self.hear(graph, 3, lambda text: '"stopped":false' in text)
        self.assertEqual(self.command(graph, "estop"), ["ok"])
        self.hear(graph, 3, lambda text: '"stopped":true' in text)
        self.stop(process)


if __name__ == "__main__":
    unittest.main(verbosity=2)
