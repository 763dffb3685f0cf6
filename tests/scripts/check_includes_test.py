#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The check of includes finds what it is there for, and nothing in this tree."""

import subprocess
import sys
import unittest

from trees import SCRIPTS, check


class Includes(unittest.TestCase):
    def test_this_tree_passes(self):
        done = subprocess.run([sys.executable, str(SCRIPTS / "check_includes.py")], stdout=-1)
        self.assertEqual(done.returncode, 0, done.stdout.decode())

    def test_each_name_without_its_header_is_named(self):
        for text, missing in {
            "#include <cstdio>\nstd::uint32_t a;": "2: std::uint32_t needs <cstdint>",
            "#include <vector>\nstd::string a;": "2: std::string needs <string>",
            "#include <gtest/gtest.h>\nvoid f(std::any);": "2: std::any needs <any>",
            "#include <set>\nauto a = std::ranges::min(b);": "2: std::ranges::min needs <algorithm>",
            "bool f() { return errno == 0; }": "1: errno needs <cerrno>",
            "// std::map\n\nauto a = std::sqrt(2);": "3: std::sqrt needs <cmath>",
        }.items():
            with self.subTest(text):
                status, out = check("check_includes.py", {"lib/a.cpp": text})
                self.assertEqual((status, out), (1, "lib/a.cpp:" + missing + "\n"))

    def test_a_header_of_ours_counts_and_text_does_not(self):
        status, out = check(
            "check_includes.py",
            {
                "lib/hc/base/a.h": "#include <string>",
                "lib/hc/base/b.h": "#include <hc/base/a.h>",
                "lib/b/b.cpp": '#include "c.h"\nstd::string a = "std::map";  // std::set',
                "lib/b/c.h": "#include <hc/base/b.h>\n/* std::optional\n */",
                "modules/a/main.cpp": "#include <signal.h>\nint a = SIGTERM;",
            },
        )
        self.assertEqual(status, 0, out)


if __name__ == "__main__":
    unittest.main()
