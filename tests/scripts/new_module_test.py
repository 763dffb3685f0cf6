#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A module that ./dev new begins compiles, passes its case, and is where the build finds it.

    new_module_test.py BUILD_FOLDER
"""

import json
import os
import pathlib
import shutil
import shlex
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = None  # set from the command line
MODEL = "brightness"  # the module whose commands are taken
NAME = "new_gauge"
SCRIPTS = ("new_module", "run_case", "check_layers.py")


class NewModule(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for name in ("scripts", "modules"):
            (self.root / name).mkdir()
        for name in SCRIPTS:
            shutil.copy(ROOT / "scripts" / name, self.root / "scripts")
        shutil.copytree(ROOT / "templates", self.root / "templates")
        self.module = self.root / "modules" / NAME

    def run_command(self, *command, **options):
        done = subprocess.run(command, stdout=-1, stderr=subprocess.STDOUT, **options)
        return done.returncode, done.stdout.decode()

    def begin(self, name):
        return self.run_command("scripts/new_module", name, cwd=self.root)

    def succeed(self, *command, **options):
        status, out = self.run_command(*command, **options)
        self.assertEqual(status, 0, out)

    def compile(self, program):
        """Compiles and links main.cpp as the build does with another module's."""
        listed = json.loads((BUILD / "compile_commands.json").read_text())
        source = str(ROOT / "modules" / MODEL / "main.cpp")
        words = shlex.split(next(each["command"] for each in listed if each["file"] == source))
        model_object = words[words.index("-o") + 1]
        new_object = str(self.root / "main.o")
        other = {source: str(self.module / "main.cpp"), model_object: new_object}
        self.succeed(*[other.get(word, word) for word in words], cwd=BUILD)

        target = "libexec/hypercolumn/" + MODEL
        listed = subprocess.run(
            ["ninja", "-t", "commands", target], cwd=BUILD, stdout=-1, check=True
        )
        command = listed.stdout.decode().splitlines()[-1]
        self.assertIn(" -o %s " % target, command)
        command = command.replace(" %s " % model_object, " %s " % shlex.quote(new_object))
        command = command.replace(" -o %s " % target, " -o %s " % shlex.quote(str(program)))
        self.succeed("sh", "-c", command, cwd=BUILD)

    def test_it_compiles_and_passes_its_case(self):
        self.assertEqual(self.begin(NAME)[0], 0)
        self.assertIn("hc_module(%s)" % NAME, (self.module / "CMakeLists.txt").read_text())
        for path in self.module.rglob("*"):
            self.assertFalse(path.is_file() and "@NAME@" in path.read_text(), path)
        self.succeed(sys.executable, "scripts/check_layers.py", ".", cwd=self.root)
        if shutil.which("clang-format"):
            style = "--style=file:%s/.clang-format" % ROOT
            self.succeed("clang-format", style, "-n", "-Werror", str(self.module / "main.cpp"))

        build = self.root / "build"
        modules = build / "libexec/hypercolumn"
        modules.mkdir(parents=True)
        (build / "bin").mkdir()
        shutil.copy(BUILD / "bin/hc", build / "bin")
        self.compile(modules / NAME)
        case = self.module / "cases/multiplies"
        self.succeed("scripts/run_case", str(build), str(case), cwd=self.root)
        (case / "out").write_text("something else\n")
        status, _ = self.run_command("scripts/run_case", str(build), str(case), cwd=self.root)
        self.assertEqual(status, 1)

    def test_wrong_names_are_refused(self):
        self.assertEqual(self.begin(NAME)[0], 0)
        for name in ("", "Gauge", "1st", "two-words", "a/b", "x" * 41, NAME):
            with self.subTest(name):
                status, out = self.begin(name)
                self.assertEqual(status, 2)
                self.assertTrue(out.startswith("new_module: "), out)
        self.assertEqual(
            [path.name for path in (self.root / "modules").iterdir() if path.is_dir()], [NAME]
        )


if __name__ == "__main__":
    BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
    os.environ.pop("HC_ACCEPT", None)  # ./dev test --accept is for the cases of the modules
    unittest.main()
