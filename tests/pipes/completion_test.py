#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Completion of words in zsh and fish, by these shells; that in bash is in tool_test.py."""

import os
import pty
import re
import shutil
import unittest

from graphs import Graphs

# What is typed, and the line after the key for completion; of words that begin alike, what they
# share. NAME is that of a running graph.
LINES = {
    "hc recor": "hc record",
    "hc brigh": "hc brightness",
    "hc cat --js": "hc cat --json",
    "hc graph unl": "hc graph unlink",
    "hc run score_au": "hc run score_augment",
    "hc depth --match": "hc depth --matcher",
    "hc cat numbers.m": "hc cat numbers.mtp",
    "hc completion z": "hc completion zsh",
    "hc top --of compl": "hc top --of NAME",
    "hc cat --of NAME camera.l": "hc cat --of NAME camera.left",
    "hc send --of NAME --to bright": "hc send --of NAME --to brightness.image",
    "hc graph --of NAME restart cam": "hc graph --of NAME restart camera",
    "hc graph --of NAME set camera.lo": "hc graph --of NAME set camera.loop=",
    "hc graph --of=NAME set camera.lo": "hc graph --of=NAME set camera.loop=",
}


class Completion(Graphs):
    def setUp(self):
        super().setUp()
        self.environment.update(HOME=self.folder.name, TERM="dumb")
        self.write("numbers.mtp", "")
        name, _ = self.run_named("completed")
        self.lines = {
            typed.replace("NAME", name): expected.replace("NAME", name)
            for typed, expected in LINES.items()
        }

    def read_until(self, pattern):
        while not (found := re.search(pattern, self.shown)):
            self.shown += os.read(self.terminal, 4096).decode(errors="replace").replace("\r", "")
        self.shown = self.shown[found.end() :]
        return found

    def check_zsh(self, setup):
        """Types the lines into a zsh after such a line."""
        self.terminal, other = pty.openpty()
        self.addCleanup(os.close, self.terminal)
        self.shown = ""
        process = self.start("exec zsh -f -i", stdin=other, stdout=other, stderr=other)
        os.close(other)
        os.write(
            self.terminal, b"unsetopt zle_bracketed_paste; %s; echo re''ady\n" % setup.encode()
        )
        self.read_until(r"\nready\n")
        for typed, expected in self.lines.items():
            with self.subTest(typed):
                os.write(self.terminal, typed.encode() + b"\t\x01echo got: \n")
                self.assertEqual(self.read_until(r"\ngot: (.*?) *\n")[1], expected)
        os.write(self.terminal, b"exit\n")
        process.wait()

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_zsh_reads_the_script(self):
        self.check_zsh("autoload -U compinit; compinit -u -D; . <(hc completion zsh)")

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_zsh_finds_the_script(self):
        self.shell("mkdir functions; hc completion zsh >functions/_hc")
        self.check_zsh("fpath=(functions $fpath); autoload -U compinit; compinit -u -D")

    @unittest.skipUnless(shutil.which("fish"), "fish is not installed")
    def test_fish(self):
        for typed, expected in self.lines.items():
            with self.subTest(typed):
                command = "fish -c 'hc completion fish | source; complete -C \"%s\"'" % typed
                words = [line.split("\t")[0] for line in self.shell(command).splitlines()]
                self.assertIn(os.path.commonprefix(words), expected.split()[-1])
                self.assertIn(expected.split()[-1], words + [os.path.commonprefix(words)])


if __name__ == "__main__":
    unittest.main()
