#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What @NAME@ does, seen from outside."""

import json
import pathlib
import socket
import subprocess
import sys
import tempfile
import unittest

PROGRAM = str(pathlib.Path(__file__).resolve().parent / "@NAME@")
IN = b"1 7 0 0 8 1763683200000000000 120190 0 0 3 1\n1 2.5 -3\n"
OUT = b"1 1 0 0 8 1763683200000000000 120190 0 0 3 1\n2 5 -6\n"


class Module(unittest.TestCase):
    def start(self, *arguments):
        process = subprocess.Popen(
            [sys.executable, PROGRAM, *arguments], stdin=-1, stdout=-1, stderr=-1
        )
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def run_module(self, data, *arguments):
        process = self.start(*arguments)
        out, err = process.communicate(data, timeout=60)
        return process.returncode, out, err.decode()

    def test_it_doubles(self):
        self.assertEqual(self.run_module(IN), (0, OUT, ""))
        empty = b"1 7 0 0 8 0 120190 0 0 0 4\n\n"
        self.assertEqual(self.run_module(empty)[1], empty.replace(b"1 7", b"1 1"))

    def test_its_factor(self):
        self.assertEqual(self.run_module(IN, "--factor=-1")[1].splitlines()[1], b"-1 -2.5 3")
        status, _, err = self.run_module(IN, "--factor", "many")
        self.assertEqual((status, len(err.splitlines())), (2, 1), err)

    def test_it_writes_the_canonical_form(self):
        words = "0.1 100 1e+05 12345 1.5e-07 -0 nan -inf 5e-324 123456789012345683968"
        data = b"1 1 0 0 8 5 120190 0 0 10 1\n%s\n" % words.encode()
        self.assertEqual(self.run_module(data, "--factor=1")[1], data)

    def test_binary_comes_back(self):
        status, out, _ = self.run_module(IN, "--encoding", "product=binary", "--factor", "1")
        self.assertEqual(status, 0)
        self.assertEqual(self.run_module(out)[1], OUT)

    def test_an_invalid_message_is_refused_in_one_line(self):
        for data in (b"rubbish\n", b"1 2\n", IN[:-3], IN.replace(b"3 1\n", b"4 1\n"),
                     IN.replace(b"120190", b"30301"), IN.replace(b"2.5", b"x")):  # fmt: skip
            status, _, err = self.run_module(data)
            self.assertEqual((status, len(err.splitlines())), (1, 1), (data, err))

    def test_links_are_sockets(self):
        with tempfile.TemporaryDirectory() as folder, socket.socket(socket.AF_UNIX) as before:
            before.bind(folder + "/before")
            before.listen()
            with socket.create_server(("127.0.0.1", 0)) as behind:
                self.start(
                    "--in=numbers=unix:%s/before?wait=9" % folder,
                    "--out=product=tcp:%d" % behind.getsockname()[1],
                )
                reader, writer = behind.accept()[0], before.accept()[0]
                with reader, writer:
                    writer.sendall(IN)
                    writer.shutdown(socket.SHUT_WR)
                    self.assertEqual(reader.makefile("rb").read(), OUT)

    def test_it_describes_itself(self):
        status, out, _ = self.run_module(b"", "--describe")
        described = json.loads(out)
        self.assertEqual((status, described["name"]), (0, "@NAME@"))
        self.assertEqual(described["parameters"][0]["name"], "factor")


if __name__ == "__main__":
    unittest.main()
