#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Modules for Node.js and Java, those of the templates, in graphs with modules in C++."""

import os
import pathlib
import re
import shutil
import signal
import socket
import struct
import unittest

from graphs import GRAPH, Graphs
from harness import ROOT, WATCHDOG, free_port, listens, wait_until

# The module is there twice, so that one link has it at both ends.
MODULES = """
[modules.first]
program = "./module"
inputs.numbers = "brightness.mean"
[modules.second]
program = "./module"
inputs.numbers = "first.product"
[modules.relay]
inputs.in = "second.product"
outputs.out = "tcp-listen:%d?readers=0&keep=latest"
"""
NAMES = ["brightness", "first", "second", "relay"]
TEXT = b"1 7 0 5 8 1763683200123456789 120190 2 9 3 1\n1 2.5 -inf\n"
PRODUCT = b"1 4 0 0 8 1763683200123456789 120191 2 9 3 1\n" + struct.pack("<3d", 3, 7.5, -1e999) + b"\n"  # fmt: skip
ANOTHER_USER = 65534


class Language:
    """What holds for the module of each language."""

    def setUp(self):
        super().setUp()
        shutil.copy(ROOT / "templates" / self.language / "module", self.path("module"))
        self.port = free_port()

    def pid(self, state, name):
        return self.module(state, name)["pid"]

    def run_modules(self):
        process = self.running_graph(GRAPH + MODULES % self.port, last="relay: started")
        return process, self.observe(process)

    def kill(self, observed, name):
        """Kills a module, which may just be restarted as its neighbour was killed."""
        while True:
            pid = self.pid(self.state(observed, lambda state: self.pid(state, name)), name)
            try:
                os.kill(pid, signal.SIGKILL)
                return pid
            except ProcessLookupError:
                pass

    def receive(self):
        """A number that comes out of the last module, once one does."""

        def attempt():
            with socket.socket() as link:
                link.settimeout(WATCHDOG)
                if link.connect_ex(("127.0.0.1", self.port)) != 0:
                    return None
                stream = link.makefile("rb")
                return len(stream.readline()) and struct.unpack("<d", stream.read(8))[0]

        return wait_until(attempt)

    def ports(self, state):
        """The ports of the links, as the modules' command lines have them."""
        found = set()
        for name in NAMES:
            file = pathlib.Path("/proc/%d/cmdline" % self.pid(state, name))
            text = file.read_text() if file.exists() else ""
            for port in re.findall(r"=tcp(?:-listen)?:127.0.0.1:(\d+)\?[^\0]*same_user=1", text):
                found.add((name, int(port)))
        return found

    def connect(self, port):
        with socket.socket() as probe:
            return probe.connect_ex(("127.0.0.1", port)) == 0

    def test_a_message_becomes_another(self):
        there, back = free_port(), free_port()
        self.start(
            "exec ./module --name m --address product=4 --factor=3 --in numbers=tcp-listen:%d "
            "--out 'product=tcp-listen:127.0.0.1:%d?readers=1'" % (there, back)
        )
        for message in TEXT, PRODUCT.replace(b" 0 0 8", b" 0 1 8"):
            link = wait_until(lambda: self.connect_to(there))
            link.sendall(message)
            if message is TEXT:
                reader = wait_until(lambda: self.connect_to(back)).makefile("rb")
            header, numbers = reader.readline(), struct.unpack("<3d", reader.read(25)[:-1])
            if message is TEXT:
                self.assertEqual(header + struct.pack("<3d", *numbers) + b"\n", PRODUCT)
            link.close()
        self.assertEqual((header.split()[3], numbers), (b"1", (9, 22.5, float("-inf"))))

    def connect_to(self, port):
        link = socket.socket()
        link.settimeout(WATCHDOG)
        if link.connect_ex(("127.0.0.1", port)) != 0:
            link.close()
            return None
        self.addCleanup(link.close)
        return link

    def test_what_is_no_message_ends_it_with_an_error(self):
        port = free_port()
        process = self.start("exec ./module --name m --in numbers=tcp-listen:%d" % port)
        wait_until(lambda: self.connect_to(port)).sendall(b"GET / HTTP/1.1\n")
        _, err = process.communicate(timeout=WATCHDOG)
        self.assertEqual(process.returncode, 1)
        self.assertRegex(err.decode(), "^m: Malformed: R4: .*\n$")
        self.shell("./module --factor many", 2)

    def test_each_end_of_its_links_may_be_killed_and_restarted(self):
        process, observed = self.run_modules()
        before = self.receive()
        state = self.state(observed)
        links = {link["from"]: link["transport"] for link in state["links"]}
        self.assertEqual(links["camera.left"], "shm")
        self.assertEqual({links[name] for name in ("brightness.mean", "first.product")}, {"tcp"})
        ports = self.ports(state)
        self.assertEqual((len(ports), len({port for _, port in ports})), (6, 3))
        for name in NAMES:
            killed = self.kill(observed, name)
            self.state(observed, lambda state: self.pid(state, name) not in (0, killed))
            self.assertEqual(self.receive(), before)
        self.assertEqual(self.ask(process, "restart first"), ["ok"])
        self.assertEqual(self.ask(process, "set second.factor=6")[0], "ok")
        wait_until(lambda: self.receive() == 3 * before)
        wait_until(lambda: self.ports(self.state(observed)) == ports)

    @unittest.skipIf(os.geteuid() != 0, "only root can be another user")
    def test_another_user_is_not_let_in(self):
        port = free_port()
        where = "127.0.0.1:%d?readers=1&same_user=1" % port
        source = free_port()
        self.start(
            "exec ./module --in numbers=tcp-listen:%d --out 'product=tcp-listen:%s'"
            % (source, where)
        )
        wait_until(lambda: listens(port) or self.listens_in_v6(port))
        os.seteuid(ANOTHER_USER)
        try:
            foreign = socket.socket()
        finally:
            os.seteuid(0)
        with foreign:
            foreign.settimeout(WATCHDOG)
            foreign.connect(("127.0.0.1", port))
            reader = self.connect_to(port)
            wait_until(lambda: self.connect_to(source)).sendall(TEXT)
            self.assertEqual(foreign.recv(1), b"")
        self.assertEqual(reader.recv(2), b"1 ")

    @staticmethod
    def listens_in_v6(port):
        wanted = "0000000000000000FFFF00000100007F:%04X 0" % port
        return wanted in pathlib.Path("/proc/net/tcp6").read_text()


@unittest.skipUnless(shutil.which("node"), "Node.js is not installed")
class JavaScript(Language, Graphs):
    language = "javascript"


@unittest.skipUnless(shutil.which("javac"), "a JDK is not installed")
class Java(Language, Graphs):
    language = "java"

    def run_modules(self):
        # Each start compiles the module again, faster without optimization.
        self.environment["JDK_JAVA_OPTIONS"] = "-XX:TieredStopAtLevel=1 -XX:+UseSerialGC"
        return super().run_modules()


if __name__ == "__main__":
    unittest.main()
