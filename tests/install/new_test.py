#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What `hc new module` makes passes its tests beside an installed Hypercolumn, and works in a pipe
and in a graph.

    new_test.py BUILD_FOLDER COMPILER
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

WATCHDOG = 300  # seconds after which a program hangs
IN = "1 7 0 0 8 1763683200000000000 120190 0 0 2 1\n1 2.5\n"
GRAPH = """version = 1
[modules.first]
program = "./py_gauge/py_gauge"
[modules.second]
program = "./cc/cc_gauge/build/cc_gauge"
parameters.factor = 10
[[modules.first.inputs.numbers]]
from = "file:in.mtp"
[[modules.second.inputs.numbers]]
from = "first.product"
[[modules.second.outputs.product]]
to = "file:out.mtp"
"""


class New(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        prefix = pathlib.Path(cls.folder.name) / "prefix"
        command = ["cmake", "--install", BUILD, "--prefix", prefix]
        subprocess.run(command, stdout=-3, check=True, timeout=WATCHDOG)
        os.symlink("/usr/bin/python3", cls.folder.name + "/python3")  # which has NumPy
        path = "%s/bin:%s:%s" % (prefix, cls.folder.name, os.environ["PATH"])
        cls.environment = dict(os.environ, PATH=path)
        cls.environment.update(CXX=COMPILER, CMAKE_GENERATOR="Ninja")

    def shell(self, command, status=0, data=""):
        done = subprocess.run(
            ["bash", "-c", "set -eo pipefail; " + command],
            cwd=self.folder.name,
            env=self.environment,
            input=data.encode(),
            capture_output=True,
            timeout=WATCHDOG,
        )
        self.assertEqual(done.returncode, status, (command, done.stdout, done.stderr))
        self.err = done.stderr.decode()
        return done.stdout.decode()

    def begin(self, arguments):
        """Makes a module, and does what it says is next: its tests."""
        said = self.shell("hc new module " + arguments)
        self.assertEqual(len(said.splitlines()), 1, said)
        return self.shell(said.split("next: ")[1])

    def test_both_pass_their_tests_and_work_in_pipes_and_graphs(self):
        self.begin("py_gauge --python")
        self.assertIn("100% tests passed", self.begin("cc_gauge --folder cc"))
        for program in ("./py_gauge/py_gauge", "cc/cc_gauge/build/cc_gauge"):
            command = "hc %s --factor 10 | hc cat --json" % program
            self.assertIn('"elements":[[10,25]]', self.shell(command, data=IN))
            self.assertIn("factor", self.shell("hc %s --help" % program))
            self.assertIn('"product"', self.shell("hc describe ./" + program))
        found = "PATH=$PATH:py_gauge:cc/cc_gauge/build; "
        piped = self.shell(found + "hc py_gauge | hc cc_gauge | hc cat --json", data=IN)
        self.assertIn('"elements":[[4,10]]', piped)
        root = pathlib.Path(self.folder.name)
        for path in root.glob("*_gauge/**/*"):
            if path.is_file() and "build" not in path.parts:
                text = path.read_text()
                self.assertFalse("@NAME@" in text or "SPDX" in text, path)

        (root / "in.mtp").write_text(IN)
        (root / "g.toml").write_text(GRAPH)
        self.assertIn("no problems found", self.shell("hc check g.toml"))
        self.shell("hc run g.toml")
        self.assertIn('"elements":[[20,50]]', self.shell("hc cat --json out.mtp"))

    def test_another_python_first_in_path(self):
        self.shell("mkdir other; ln -s /bin/false other/python3")
        self.environment = dict(
            self.environment, PATH="%s/other:%s" % (self.folder.name, self.environment["PATH"])
        )
        self.begin("second --python")

    def test_the_commands_of_the_readme_work(self):
        for arguments in ("python_one --python", "cpp_one"):
            self.shell("hc new module " + arguments)
            name = arguments.split()[0]
            text = pathlib.Path(self.folder.name, name, "README.md").read_text()
            (commands,) = re.findall(r"```sh\n(.*?)```", text, re.S)
            self.assertIn("\n  10 25\n", self.shell("cd %s\n%s" % (name, commands)))

    def test_why_no_python_has_the_package_is_told(self):
        self.shell(
            "mkdir broken; echo 'raise ImportError(\"broken on purpose\")' >broken/hypercolumn.py"
        )
        self.shell("PYTHONPATH=broken hc new module third --python")
        self.assertRegex(
            self.err, r"no Python has .*: python3: ImportError: broken on purpose; /usr"
        )

    def test_names_that_are_wrong_or_there_are_refused_in_one_line(self):
        self.shell("mkdir there")
        for arguments in ("Gauge", "1st", "two-words", "a/b", "''", "x" * 41, "there", ""):
            with self.subTest(arguments):
                self.assertEqual(self.shell("hc new module --python " + arguments, 2), "")
                self.assertEqual(len(self.err.splitlines()), 1, self.err)
        self.shell("hc new module gauge --folder /dev/null", 1)
        self.assertEqual(len(self.err.splitlines()), 1, self.err)
        self.assertEqual(list(pathlib.Path(self.folder.name, "there").iterdir()), [])


if __name__ == "__main__":
    COMPILER = sys.argv.pop(2)
    BUILD = sys.argv.pop(1)
    unittest.main()
