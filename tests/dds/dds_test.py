#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""dds: links against a program of Cyclone DDS that knows spec/message.idl alone, both directions.

dds_test.py BUILD_FOLDER [TEST …]
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
GRAPHS = pathlib.Path(__file__).resolve().parents[2] / "graphs"
DATA = pathlib.Path(os.environ.get("HC_DATA", "/usr/share/doc/opencv-doc/examples/data"))
HC, PEER = BUILD / "bin/hc", BUILD / "tests/programs/dds_peer"
WATCHDOG = 30  # [s]
# Loopback alone, as dds: links have it.
LOOPBACK = (
    '<General><AllowMulticast>false</AllowMulticast><Interfaces><NetworkInterface address="127.0.0.1"/>'
    "</Interfaces></General><Discovery><ExternalDomainId>96</ExternalDomainId>"
    "<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>119</MaxAutoParticipantIndex>"
    '<Peers><Peer address="127.0.0.1"/></Peers></Discovery>'
)
# Three tables, the last of which takes many packets.
MESSAGES = [
    b"1 1 0 0 8 0 40100 0 0 2 2\n1 2\n3 4\n",
    b"1 1 0 1 9 0 40100 0 0 3 1\n5 6 7\n",
    b"1 1 0 2 10 0 40100 0 0 1 50000\n" + b"".join(b"%d\n" % (i % 256) for i in range(50000)),
]


class Dds(unittest.TestCase):
    def setUp(self):
        self.topic = "test/peer%d" % os.getpid()
        self.uri = "dds:%s?domain=96" % self.topic
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def peer(self, *arguments):
        return [PEER, arguments[0], self.topic, *arguments[1:]]

    def start(self, command, folder=None, **environment):
        if command[0] == PEER:
            environment["CYCLONEDDS_URI"] = LOOPBACK
        process = subprocess.Popen(
            command, stdout=-1, stderr=-1, cwd=folder, env={**os.environ, **environment}
        )
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def output(self, process):
        out, err = process.communicate(timeout=WATCHDOG)
        self.assertEqual(process.returncode, 0, err)
        return out

    def files(self):
        paths = [pathlib.Path(self.folder.name, str(i)) for i in range(len(MESSAGES))]
        for path, message in zip(paths, MESSAGES):
            path.write_bytes(message)
        return paths

    def test_a_program_from_the_idl_is_read(self):
        reader = self.start([HC, "cat", "--raw", self.uri])
        writer = self.start(self.peer("write", *self.files()))
        self.assertEqual(self.output(reader), b"".join(MESSAGES))
        self.output(writer)

    def test_a_sample_may_have_several_messages(self):
        path = pathlib.Path(self.folder.name, "both")
        path.write_bytes(b"".join(MESSAGES))
        reader = self.start([HC, "cat", "--raw", self.uri])
        writer = self.start(self.peer("write", path, path))
        self.assertEqual(self.output(reader), b"".join(MESSAGES) * 2)
        self.output(writer)

    def test_a_program_from_the_idl_is_written(self):
        reader = self.start(self.peer("read"))
        path = pathlib.Path(self.folder.name, "both")
        path.write_bytes(b"".join(MESSAGES))
        self.output(
            self.start([HC, "play", "--speed", "max", "--out", self.uri + "&readers=1", path])
        )
        self.assertEqual(self.output(reader), b"".join(MESSAGES))

    def test_the_graphs_of_a_fleet_share_a_camera(self):
        robot = "robot%d" % os.getpid()
        images = pathlib.Path(
            self.folder.name, "images"
        )  # different ones, since equal ones are throttled
        images.mkdir()
        for number in range(1, 6):
            name = "left0%d.jpg" % number
            (images / name).symlink_to(DATA / name)
        words = {"HC_ROBOT": robot, "HC_DOMAIN": "96", "HC_KEEP": "all", "HC_WINDOW": "no"}
        folders = [pathlib.Path(self.folder.name, name) for name in ("a", "b")]
        watchers = []
        for folder in folders:
            folder.mkdir()
            graph = GRAPHS / "fleet_watch.toml"
            command = [HC, "run", graph, "--links", "--set", "view.save=seen.png"]
            watchers.append(self.start(command, folder, **words))
        graph = GRAPHS / "fleet_camera.toml"
        count = ["--set", "camera.count=5"]
        camera = self.start([HC, "run", graph, *count], HC_READERS="4", HC_CAMERA=images, **words)
        self.output(camera)
        for folder, watcher in zip(folders, watchers):
            out = self.output(watcher).decode()
            self.assertRegex(out, r"ran for .*: 2 modules, 10 messages")
            self.assertTrue((folder / "seen.png").exists(), out)


if __name__ == "__main__":
    unittest.main()
