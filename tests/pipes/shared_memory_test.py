# SPDX-License-Identifier: Apache-2.0
"""shm: links between whole programs."""

import os
import pathlib
import signal
import unittest

import harness
from harness import WATCHDOG, wait_until


def listens_at(name):
    return "@hypercolumn-shm-" + name in pathlib.Path("/proc/net/unix").read_text()


class SharedMemory(harness.Pipes):
    def setUp(self):
        super().setUp()
        self.name = "test-%d-%s" % (os.getpid(), self.id().rsplit(".", 1)[1][:20])
        self.uri = "shm:" + self.name

    def many(self, count, path="many.mtp"):
        """A recording of images that their seq determines."""
        with open(self.path(path), "wb") as file:
            for i in range(count):
                file.write(
                    b"1 5 0 %d 8 0 40101 0 0 200 100\n" % i + bytes([i % 251]) * 20000 + b"\n"
                )

    def test_two_readers_get_the_same_bytes(self):
        self.many(500)
        readers = [
            self.start("exec hc record %d.mtp --in '%s?wait=60'" % (i, self.uri)) for i in range(2)
        ]
        self.shell("hc play --speed max many.mtp --out '%s?readers=2'" % self.uri)
        for reader in readers:
            self.assertEqual(reader.wait(WATCHDOG), 0)
        self.shell("cmp many.mtp 0.mtp && cmp many.mtp 1.mtp")

    def test_a_killed_publisher_leaves_whole_messages_and_its_name(self):
        self.many(50)
        reader = self.start("exec hc record got.mtp --in '%s?wait=60'" % self.uri)
        publisher = self.start("exec hc play --loop --speed max many.mtp --out %s" % self.uri)
        got = pathlib.Path(self.path("got.mtp"))
        wait_until(lambda: got.exists() and got.stat().st_size > 100_000)
        os.kill(publisher.pid, signal.SIGKILL)
        _, err = reader.communicate(timeout=WATCHDOG)
        self.assertEqual(reader.returncode, 1)  # its stream was cut
        line = "hc record: Closed: %s?wait=60: the publisher has died\n" % self.uri
        self.assertEqual(err.decode(), line)
        self.assertIn(" messages, ", self.shell("hc info got.mtp"))  # all of them are whole
        self.assertFalse(listens_at(self.name))
        self.test_two_readers_get_the_same_bytes()


if __name__ == "__main__":
    unittest.main()
