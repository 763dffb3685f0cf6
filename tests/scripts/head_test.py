#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The target `head`, which ./dev run builds, has each program of the head's graph, and the recorder.

    head_test.py BUILD_FOLDER
"""

import pathlib
import re
import subprocess
import sys
import tomllib
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = None  # set from the command line


def programs_of(path):
    graph = tomllib.loads(path.read_text())
    for name, module in graph["modules"].items():
        yield module.get("program", name)
    for included in graph.get("graphs", {}).values():
        file = re.sub(r"\$\{\w+:-(.*)\}", r"\1", included["file"])
        yield from programs_of(path.parent / file)


class Head(unittest.TestCase):
    def test_it_has_each_program_of_the_graph(self):
        command = ["ninja", "-C", str(BUILD), "-t", "query", "head"]
        listed = subprocess.run(command, stdout=-1, check=True).stdout.decode().split()
        built = {name.split("/")[-1] for name in listed if name.startswith("libexec/")}
        self.assertEqual(built, {*programs_of(ROOT / "graphs/head.toml"), "recorder"})
        self.assertIn("bin/hc", listed)


if __name__ == "__main__":
    BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
