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

    def start(self, command):
        environment = {**os.environ, "CYCLONEDDS_URI": LOOPBACK} if command[0] == PEER else None
        process = subprocess.Popen(command, stdout=-1, stderr=-1, env=environment)
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


if __name__ == "__main__":
    unittest.main()
