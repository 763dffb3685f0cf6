#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Links to a peer whose name is unknown at first, and whose address changes.

In full, by HC_FULL=1, a time is required: a name is in use within 5 s of when it is known.
"""

import os
import shlex
import time
import unittest

from namespaces import UNSHARE, move_to_own_network

# A name server would answer in its own time.
OWN = move_to_own_network("ip link set lo up")

# It takes an argument away.
from harness import Pipes, WATCHDOG, free_port, wait_until  # noqa: E402

BACK = 5 if os.environ.get("HC_FULL") else WATCHDOG  # [s]


def read_sockets():
    with open("/proc/net/tcp", encoding="ascii") as table:
        return table.read()


@unittest.skipUnless(OWN, "no network of one's own")
class Names(Pipes):
    def know(self, lines):
        """Replaces the contents of the table of names, and not the file, which is mounted."""
        with open(self.path("hosts"), "w", encoding="ascii") as hosts:
            hosts.write("127.0.0.1 localhost\n" + lines)

    def start_reader(self, uri):
        """With a table of names of its own."""
        command = 'mount --bind hosts /etc/hosts && exec hc cat --raw "%s" >seen 2>said' % uri
        return self.start(shlex.join([*UNSHARE, "--mount", "sh", "-c", command]))

    def start_writer(self, address, value):
        """Sends an image of this value again and again."""
        self.write("%d.ppm" % value, b"P6 1 1 255\n" + bytes([value] * 3))
        return self.start(
            "exec hc camera %d.ppm --loop --rate 20 --encoding text"
            " --out 'left=tcp-listen:%s:%d?readers=0&keep=latest'" % (value, address, self.port)
        )

    def wait_for(self, value):
        begin = time.monotonic()
        wait_until(lambda: "\n%d %d %d\n" % (value, value, value) in self.read("seen"))
        self.assertLess(time.monotonic() - begin, BACK)

    def test_a_name_that_is_known_later_and_an_address_that_changes(self):
        self.port = free_port()
        self.know("")
        writer = self.start_writer("127.0.0.2", 42)
        reader = self.start_reader("tcp:robot.test:%d?reconnect=100" % self.port)
        wait_until(lambda: "no peer yet (robot.test: " in self.read("said"))
        self.know("127.0.0.2 robot.test\n")
        self.wait_for(42)

        self.know("127.0.0.3 robot.test\n")
        self.start_writer("127.0.0.3", 43)
        wait_until(lambda: "0300007F:%04X 00000000:0000 0A" % self.port in read_sockets())
        self.end(writer)
        self.wait_for(43)
        self.assertIsNone(reader.poll())


if __name__ == "__main__":
    unittest.main()
