#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The commit that `hc --version` says, in trees of git and outside."""

import os
import pathlib
import re
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).parents[2] / "cmake/commit.cmake"
NAMES = {
    "GIT_%s_%s" % (who, what): "a@b"
    for who in ("AUTHOR", "COMMITTER")
    for what in ("NAME", "EMAIL")
}


class Commit(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.output = pathlib.Path(folder.name, "commit.cpp")
        self.source = pathlib.Path(folder.name, "source")
        self.source.mkdir()

    def git(self, *words):
        done = subprocess.run(
            ["git", *words], cwd=self.source, env={**os.environ, **NAMES}, stdout=-1, check=True
        )
        return done.stdout.decode().strip()

    def make_commit(self):
        (self.source / "file").write_text("1")
        self.git("init", "--quiet")
        self.git("add", "file")
        self.git("commit", "--quiet", "-m", "one")
        return self.git("rev-parse", "HEAD")[:12]

    def commit_of(self, source):
        command = ["cmake", "-D", "SOURCE=%s" % source, "-D", "OUTPUT=%s" % self.output]
        subprocess.run([*command, "-P", SCRIPT], check=True)
        return re.search(r'kCommit\[\] = "(.*)"', self.output.read_text())[1]

    def test_a_commit(self):
        commit = self.make_commit()
        self.git("tag", "v1")
        self.assertEqual(self.commit_of(self.source), commit)

    def test_changes_are_told(self):
        commit = self.make_commit()
        (self.source / "file").write_text("2")
        self.assertEqual(self.commit_of(self.source), commit + "-modified")

    def test_a_tree_outside_git_has_none(self):
        self.assertEqual(self.commit_of(self.source), "unknown")

    def test_that_of_another_project_around_it_is_not_taken(self):
        self.make_commit()
        inner = self.source / "inner"
        inner.mkdir()
        self.assertEqual(self.commit_of(inner), "unknown")

    def test_a_repository_without_a_commit_has_none(self):
        self.git("init", "--quiet")
        self.assertEqual(self.commit_of(self.source), "unknown")

    def test_the_same_commit_builds_nothing_again(self):
        self.make_commit()
        self.commit_of(self.source)
        os.utime(self.output, (1, 1))
        self.commit_of(self.source)
        self.assertEqual(self.output.stat().st_mtime, 1)


if __name__ == "__main__":
    unittest.main()
