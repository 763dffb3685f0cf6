#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The layer check finds each wrong arrow of a bad tree, and none in a good one or in this one."""

import pathlib
import tempfile
import unittest

import check_layers

HOME = pathlib.Path(__file__).resolve().parents[1]


def complaints(files):
    """What is said of a tree, {path: text}."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for path, text in files.items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text)
        return check_layers.check(root)


class Layers(unittest.TestCase):
    def wrong(self, path, line):
        found = complaints({path: "#pragma once\n" + line + "\n"})
        self.assertEqual(len(found), 1, (path, line, found))
        self.assertTrue(found[0].startswith(f"{path}:2: "), found)

    def right(self, path, line):
        self.assertEqual(complaints({path: line + "\n"}), [])

    def test_arrows_point_one_way(self):
        self.wrong("lib/hc/base/a.h", "#include <hc/wire/header.h>")
        self.wrong("lib/hc/wire/a.cpp", "#include <hc/link/link.h>")
        self.wrong("lib/hc/compress/a.cpp", "#  include  <hc/link/link.h>")
        self.wrong("lib/hc/link/a.cpp", "#include <hc/compress/compress.h>")
        self.wrong("lib/hc/graph/a.cpp", "#include <hc/node/module.h>")
        self.wrong("lib/hc/node/a_test.cpp", '#include "hc/graph/run.h"')
        self.wrong("lib/hc/adapter/a.h", "#include <hc/node/port.h>")
        self.wrong("lib/vision/a.cpp", "#include <hc/wire/message.h>")
        self.wrong("modules/depth/main.cpp", "#include <hc/graph/run.h>")
        self.wrong("tools/hc/a.cpp", "#include <hc/node/module.h>")
        self.right("lib/hc/node/a.cpp", "#include <hc/compress/compress.h>")
        self.right("modules/depth/main.cpp", "#include <hc/node/module.h>")
        self.right("tools/hc/a.cpp", "#include <hc/graph/run.h>")

    def test_a_module_never_includes_another(self):
        files = {"modules/a/a.h": "\n", "modules/b/main.cpp": '#include "../a/a.h"\n'}
        self.assertEqual(len(complaints(files)), 1)
        files = {"modules/a/a.h": "\n", "modules/a/main.cpp": '#include "a.h"\n'}
        self.assertEqual(complaints(files), [])

    def test_wire_is_pure(self):
        for name in ("unistd.h", "sys/socket.h", "thread", "chrono", "fstream", "cstdio"):
            self.wrong("lib/hc/wire/a.cpp", f"#include <{name}>")
        self.right("lib/hc/wire/a.cpp", "#include <charconv>")
        self.right("lib/hc/wire/a_test.cpp", "#include <fstream>")

    def test_public_headers_are_free_of_third_parties(self):
        cmake = "hc_layer(graph DEPENDS link\n  HEADERS a.h b.h\n  SOURCES a.cpp)\n"
        line = "#include <toml++/toml.h>\n"
        for name, count in (("b.h", 1), ("private.h", 0), ("a.cpp", 0)):
            files = {"lib/hc/graph/CMakeLists.txt": cmake, f"lib/hc/graph/{name}": line}
            self.assertEqual(len(complaints(files)), count, name)

    def test_this_tree_is_good(self):
        self.assertEqual(check_layers.check(HOME), [])
        self.assertGreater(len(set(check_layers.public_headers(HOME))), 20)


if __name__ == "__main__":
    unittest.main()
