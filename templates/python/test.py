#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What @NAME@ does, seen from outside. Needs `hc` on the PATH."""

import json
import os
import pathlib
import subprocess
import sys
import unittest

PROGRAM = str(pathlib.Path(__file__).resolve().parent / "@NAME@")
IN = b"1 7 0 0 8 1763683200000000000 120190 0 0 3 1\n1 2.5 -3\n"
# The program runs by the Python that runs this test.
PATH = os.path.dirname(sys.executable) + ":" + os.environ["PATH"]
OUT = b"1 1 0 0 8 1763683200000000000 120190 0 0 3 1\n2 5 -6\n"


class Module(unittest.TestCase):
    def run_module(self, data, *arguments, status=0, lines=0):
        """Gives what it sends, if it ends with that status and says so many lines."""
        command = ["hc", PROGRAM, *arguments]
        done = subprocess.run(
            command, input=data, capture_output=True, timeout=60, env={**os.environ, "PATH": PATH}
        )
        said = done.stderr.decode()
        self.assertEqual((done.returncode, said.count("\n")), (status, lines), said)
        return done.stdout

    def test_it_multiplies(self):
        self.assertEqual(self.run_module(IN), OUT)
        empty = b"1 7 0 0 8 0 120190 0 0 0 4\n\n"
        self.assertEqual(self.run_module(empty), empty.replace(b"1 7", b"1 1"))

    def test_its_factor(self):
        self.assertEqual(self.run_module(IN, "--factor=-1").splitlines()[1], b"-1 -2.5 3")
        self.run_module(IN, "--factor", "many", status=2, lines=1)

    def test_an_invalid_message_is_refused_in_one_line(self):
        for data in (b"rubbish\n", IN[:-3], IN.replace(b"120190", b"30301")):
            self.run_module(data, status=1, lines=1)

    def test_it_describes_itself(self):
        described = json.loads(self.run_module(b"", "--describe"))
        self.assertEqual(described["name"], "@NAME@")
        self.assertEqual(described["parameters"][0]["name"], "factor")


if __name__ == "__main__":
    unittest.main()
