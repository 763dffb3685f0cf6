#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The layer check finds what it is there for."""

import unittest

from trees import check


class Layers(unittest.TestCase):
    def test_a_good_tree_passes(self):
        files = {
            "lib/hc/link/tcp.cpp": "#include <hc/mtp/codec.h>\n#include <sys/socket.h>",
            "lib/vision/messages.h": "#include <hc/module/kind.h>",
        }
        self.assertEqual(check("check_layers.py", files)[0], 0)

    def test_each_wrong_arrow_is_named(self):
        for name, text in {
            "lib/hc/base/a.cpp": "#include <hc/mtp/codec.h>",
            "lib/hc/mtp/a.cpp": "#include <hc/link/link.h>",
            "lib/hc/mtp/b.cpp": "#include <sys/socket.h>",
            "lib/hc/module/a.cpp": "#include <graph/plan.h>",
            "lib/graph/a.cpp": "#include <hc/module/module.h>",
            "lib/hc/link/a.h": "#include <fmt/format.h>",
            "lib/vision/a.cpp": "#include <hc/mtp/codec.h>",
            "lib/frames/a.cpp": "#include <hc/mtp/codec.h>",
            "lib/hc/mtp/c.h": "#include <frames/tree.h>",
            "modules/a/main.cpp": '#include "../b/b.h"',
            "drivers/a/a.cpp": "#include <hc/mtp/codec.h>",
            "modules/b/main.cpp": "#include <graph/plan.h>",
            "modules/c/main.cpp": 'std::cout << "hello";',
            "lib/hc/module/b.cpp": 'printf("hello");',
            "lib/hc/new/a.cpp": "#include <vector>",
        }.items():
            with self.subTest(name):
                status, out = check("check_layers.py", {name: text})
                self.assertEqual(status, 1)
                self.assertTrue(out.startswith(name + ":1: "), out)


if __name__ == "__main__":
    unittest.main()
