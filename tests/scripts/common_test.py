#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the scripts share does what it says."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).parents[2] / "scripts"


class Common(unittest.TestCase):
    def test_without_a_build_folder_a_script_says_what_it_does(self):
        with tempfile.TemporaryDirectory() as here:
            pathlib.Path(here, "CMakeCache.txt").touch()  # a build that was not named
            for name in ("bench", "bench_mcap", "make_reference", "make_safety"):
                for arguments in [], [""], ["elsewhere"]:
                    command = [sys.executable, str(SCRIPTS / name), *arguments]
                    done = subprocess.run(command, cwd=here, stderr=-1, text=True)
                    self.assertEqual(done.returncode, 2, done.stderr)
                    self.assertIn("%s BUILD" % name, done.stderr)


if __name__ == "__main__":
    unittest.main()
