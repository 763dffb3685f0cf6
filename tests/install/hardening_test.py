#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What is installed is hardened, as readelf sees it: every program and the Python extension.

    hardening_test.py BUILD_FOLDER
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

WATCHDOG = 300  # seconds after which a program hangs


def readelf(option, path):
    return subprocess.run(
        ["readelf", "-W", option, path], stdout=-1, check=True, timeout=WATCHDOG
    ).stdout.decode()


def missing_in(path):
    """What a program or library lacks."""
    dynamic, segments, symbols = (readelf(option, path) for option in ("-d", "-l", "-s"))
    is_library = ".so" in path.suffixes
    stack = re.search(r"GNU_STACK +(?:0x\S+ +){5}(\S+)", segments)
    checks = {
        "position independent": is_library or "PIE" in dynamic,
        "read-only relocations": "GNU_RELRO" in segments,
        "bound at start": "BIND_NOW" in dynamic or re.search(r"FLAGS_1.*\bNOW\b", dynamic),
        "stack protector": "__stack_chk_fail" in symbols,
        "fortified": re.search(r"__(?!stack)\w+_chk\b", symbols),
        "no code on the stack": stack and "E" not in stack[1],
    }
    return [name for name, is_there in checks.items() if not is_there]


class Hardening(unittest.TestCase):
    def test_every_installed_binary(self):
        with tempfile.TemporaryDirectory() as folder:
            command = ["cmake", "--install", BUILD, "--prefix", folder]
            subprocess.run(command, stdout=-3, check=True, timeout=WATCHDOG)
            binaries = [
                path
                for path in pathlib.Path(folder).rglob("*")
                if path.is_file() and not path.is_symlink() and path.suffix not in (".a", ".o")
                if path.open("rb").read(4) == b"\x7fELF"
            ]
            self.assertGreater(len(binaries), 20)
            lacking = {path.name: missing_in(path) for path in binaries}
        print("%d binaries" % len(binaries), flush=True)
        self.assertEqual({name: lacks for name, lacks in lacking.items() if lacks}, {})


if __name__ == "__main__":
    BUILD = sys.argv.pop(1)
    unittest.main()
