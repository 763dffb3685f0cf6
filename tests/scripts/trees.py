# SPDX-License-Identifier: Apache-2.0
"""Runs a check of the sources on a small tree."""

import pathlib
import subprocess
import sys
import tempfile

SCRIPTS = pathlib.Path(__file__).parents[2] / "scripts"


def check(script, files):
    """Status and output of a script, on a tree of these files: their texts by their names."""
    with tempfile.TemporaryDirectory() as root:
        for name, text in files.items():
            path = pathlib.Path(root, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text + "\n")
        done = subprocess.run([sys.executable, str(SCRIPTS / script), root], stdout=-1)
        return done.returncode, done.stdout.decode()
