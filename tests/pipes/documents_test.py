#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The commands of the README and the documents."""

import pathlib
import re
import resource
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
        for block in self.commands(name):
            with self.subTest(block):
                expected = "".join(
                    line[2:] + "\n" for line in block.splitlines() if line.startswith("# ")
                )
                command = "".join(
                    line + "\n" for line in block.splitlines() if not line.startswith("# ")
                )
                out = self.shell("set -e\n" + command)
                for line in expected.splitlines():
                    pattern = re.escape(line).replace("…", ".*").replace(r"\.\.\.", ".*")
                    self.assertRegex(out + self.err, pattern)

    def test_readme(self):
        self.run_document("README.md")

    def test_tutorial(self):
        self.run_document("doc/tutorial.md")

    def test_modules(self):
        self.run_document("doc/modules.md")

    def test_module_contract(self):
        self.run_document("spec/module.md")

    def test_routing(self):
        self.run_document("doc/routing.md")

    def test_body(self):
        self.run_document("doc/body.md")

    def test_head(self):
        self.run_document("doc/head.md")

    def test_tasks(self):
        self.run_document("doc/tasks.md")

    def test_the_finder_of_the_tasks_finds_in_time_that_grows_with_the_image(self):
        text = (ROOT / "doc/tasks.md").read_text()
        self.write(
            "finder.py", re.search(r"finder\.py <<'END'\n(.*?)END\n", text, re.S)[1].encode()
        )

        def seconds(width, height, count):
            row = bytes((200, 20, 20)) * 40 + bytes((90, 90, 90)) * (width - 40)
            image = b"1 7 0 0 8 5 30131 0 7 %d %d\n" % (width, height) + row * height + b"\n"
            before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
            found = self.shell("python3 finder.py", data=image * count).splitlines()
            u, v, _ = map(float, found[1].split())
            self.assertEqual((len(found), u), (2 * count, 18))
            self.assertAlmostEqual(v, height / 2, delta=2)
            return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before

        # As many pixels in all. A finder that copies the image at each pixel takes four times as long.
        self.assertLess(seconds(800, 600, 6), 2.2 * seconds(400, 300, 24))


if __name__ == "__main__":
    unittest.main()
