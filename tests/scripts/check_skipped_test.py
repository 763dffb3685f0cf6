#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Skipped tests are found in the output of both kinds of tests."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).parents[2] / "scripts/check_skipped.py"
LOG = """[ RUN      ] Unit.needs_a_disk
a_test.cpp:57: Skipped
no disk
[  SKIPPED ] Unit.needs_a_disk (0 ms)
[ RUN      ] Unit.runs
[       OK ] Unit.runs (0 ms)
test_network (__main__.Network.test_network) ... skipped 'no network namespaces'
test_other (__main__.Network.test_other) ... ok
"""


def check(log, most):
    with tempfile.TemporaryDirectory() as build:
        path = pathlib.Path(build, "Testing/Temporary/LastTest.log")
        path.parent.mkdir(parents=True)
        path.write_text(log)
        done = subprocess.run(
            [sys.executable, str(SCRIPT), build],
            stdout=-1,
            env=dict(os.environ, HC_MAX_SKIPPED=str(most)),
        )
        return done.returncode, done.stdout.decode()


class Skipped(unittest.TestCase):
    def test_each_is_listed_with_its_reason(self):
        status, text = check(LOG, 2)
        self.assertEqual(status, 0)
        self.assertIn("skipped: Unit.needs_a_disk: no disk\n", text)
        self.assertIn("skipped: test_network: no network namespaces\n", text)
        self.assertIn("2 tests skipped, at most 2\n", text)

    def test_too_many_are_an_error(self):
        self.assertEqual(check(LOG, 1)[0], 1)
        self.assertEqual(check(LOG.replace("skipped '", "ok '"), 1)[0], 0)


if __name__ == "__main__":
    unittest.main()
