#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The commands of the README and the documents."""

import pathlib
import re
import unittest

from harness import DATA, Pipes, ROOT, free_port


class Documents(Pipes):
    """Every command of the README and the documents, as it stands there."""

    def commands(self, name):
        text = (ROOT / name).read_text()
        text = text.replace("7311", str(free_port()))  # may be somebody else's just now
        blocks = re.findall(r"```sh\n(.*?)```", text, re.S)
        self.assertTrue(blocks)
        return [block for block in blocks if "./dev" not in block]

    def run_document(self, name):
        pathlib.Path(self.path("graphs")).symlink_to(ROOT / "graphs")
        pathlib.Path(self.path("modules")).symlink_to(ROOT / "modules")
        pathlib.Path(self.path("data")).symlink_to(DATA)
        said = ""
        for block in self.commands(name):
            with self.subTest(block):
                expected = "".join(
                    line[2:] + "\n" for line in block.splitlines() if line.startswith("# ")
                )
                command = "".join(
                    line + "\n" for line in block.splitlines() if not line.startswith("# ")
                )
                out = self.shell("set -e\n" + command)
                said += out + self.err
                for line in expected.splitlines():
                    pattern = re.escape(line).replace("…", ".*").replace(r"\.\.\.", ".*")
                    self.assertRegex(out + self.err, pattern)
        return said

    def test_readme(self):
        self.run_document("README.md")

    def test_tutorial(self):
        self.run_document("doc/tutorial.md")

    def test_modules(self):
        self.run_document("doc/modules.md")

    def test_routing(self):
        self.run_document("doc/routing.md")

    def test_body(self):
        self.run_document("doc/body.md")

    def test_head(self):
        self.run_document("doc/head.md")

    def test_tasks(self):
        said = self.run_document("doc/tasks.md")
        errors = [float(error) for error in re.findall(r"RMS error ([\d.]+)°", said)]
        self.assertEqual(len(errors), 2, said)
        # 0.6° on an idle machine; a finder that is too slow for the ball has 20° and more.
        self.assertLess(max(errors), 10, said)


if __name__ == "__main__":
    unittest.main()
