#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Recordings by the page: begun, listed, downloaded, on a disk that hangs or is full."""

import contextlib
import ctypes
import json
import os
import pathlib
import re
import resource
import unittest

from harness import wait_until
from page import Page
from web_socket import connect, get, read_head


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
        (folder / "seven.mcap").write_bytes(b"not a recording")
        graph = self.socket("/graph", cookie)
        listed = json.loads(get(self.port, "/recordings", Cookie=cookie)[2])
        self.assertEqual(listed[0], {"name": "one", "bytes": size, "streams": ["messages"]})
        self.assertEqual([each["name"] for each in listed], ["one", "seven"])
        self.assertEqual([listed[1]["bytes"], listed[1]["streams"]], [15, []])
        self.assertIn("MCAP", listed[1]["problem"])
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
        self.assertEqual(len(os.listdir(folder)), 6)  # nothing was left there

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
        self.hear(graph, 2, lambda text: "the messages written before are kept" in text)
        self.hear(graph, 3, lambda text: json.loads(text)["recording"] is None)
        self.assertRegex(self.shell("hc info recordings/one.mcap"), r"camera\.left +[1-9]")

    def test_what_is_recorded_is_listed_and_read_again(self):
        process = self.serve()
        cookie = self.session()
        graph = self.socket("/graph", cookie)
        self.record(graph)
        self.assertIn("already", self.command(graph, "record two camera.left")[0])
        self.hear(graph, 3, lambda text: json.loads(text)["recording"]["bytes"] > 9999)
        self.assertIn("being recorded", self.command(graph, "record delete one")[0])
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
        for name in ("two", "../copy", "one.mcap"):
            self.assertIn("no recording", self.command(graph, "record delete " + name)[0])
        self.assertEqual(self.command(graph, "record delete one"), ["ok"])
        self.assertEqual(json.loads(get(self.port, "/recordings", Cookie=cookie)[2]), [])
        self.stop(process)


if __name__ == "__main__":
    unittest.main()
