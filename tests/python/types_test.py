#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The package's types are complete and right, and its words are described."""

import inspect
import os
import subprocess
import sys
import unittest

from package import BUILD, Package, ROOT, hc

PRIVATE = ("__", "_pybind11_")
EXAMPLE = """
import hypercolumn as hc
module = hc.Module("m", "a module")
image = module.input("image", hc.rgb_image(), "an image")
out = module.output("out", hc.table(), "a number")
factor = module.parameter("factor", 2.0, "", "a factor")

@module.on(image)
def look(message: hc.Message) -> None:
    out.send(factor.value * message.matrix.mean(), time=message.time)
    with out.loan(1, 2) as a:
        a[:] = 1

for message in hc.read("x.mtp"):
    shape: int = message.width * message.height
with hc.start("graph.toml") as graph:
    graph.parameters["m.factor"] = 2
module.run()
"""
WRONG = ("factor.value.no_such", "out.send()", "hc.read(5)", "module.on(out)", "image.matrix")


class Types(Package):
    def check(self, text):
        self.write("example.py", text)
        self.environment["MYPYPATH"] = str(BUILD / "python")
        command = [sys.executable, "-m", "mypy", "--strict", "example.py"]
        done = subprocess.run(
            command, cwd=self.folder.name, env=self.environment, capture_output=True, text=True
        )
        return done.returncode, done.stdout + done.stderr

    def test_a_type_checker_takes_what_is_right_and_nothing_else(self):
        if subprocess.run(
            [sys.executable, "-m", "mypy", "--version"], capture_output=True
        ).returncode:
            self.skipTest("no mypy here")
        self.assertEqual(self.check(EXAMPLE)[0], 0, self.check(EXAMPLE)[1])
        status, said = self.check(EXAMPLE + "\n".join(WRONG) + "\n")
        self.assertEqual((status, said.count("example.py:")), (1, len(WRONG)), said)
        command = [sys.executable, "-m", "mypy", "--strict", "-p", "hypercolumn"]
        environment = dict(os.environ, MYPYPATH=str(ROOT / "python"))
        done = subprocess.run(
            command, cwd=self.folder.name, env=environment, capture_output=True, text=True
        )
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_the_stub_has_what_the_extension_has(self):
        stub = (ROOT / "python/hypercolumn/_hypercolumn.pyi").read_text()
        from hypercolumn import _hypercolumn

        for name in dir(_hypercolumn):
            if name.startswith(PRIVATE):
                continue
            self.assertRegex(stub, r"(class|def) %s\b" % name)
            each = getattr(_hypercolumn, name)
            for member in dir(each) if inspect.isclass(each) else ():
                if not member.startswith(PRIVATE):
                    self.assertRegex(stub, r"(?m)(def %s\(|^    %s: )" % (member, member))

    def test_every_word_is_described(self):
        for name in hc.__all__:
            self.assertTrue(getattr(hc, name).__doc__, name)
        self.assertEqual(sorted(hc.__all__), hc.__all__)


if __name__ == "__main__":
    unittest.main()
