#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Two readers, one specification: hc and mtp1.py read every vector and each other's messages.

    conformance_test.py HC
"""

import json
import pathlib
import re
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import mtp1

ROOT = pathlib.Path(__file__).parents[2]
VALID = sorted((ROOT / "spec/vectors/valid").glob("*.mtp"))
INVALID = sorted((ROOT / "spec/vectors/invalid").glob("*.mtp"))
HC = "hc"
SEEDS = range(1, 4)
COUNT = 800


def run(*command, data=b""):
    return subprocess.run(command, input=data, stdout=-1, stderr=-1, timeout=100)


def hc(*words, data=b""):
    return run(HC, *words, data=data)


def python(*words, data=b""):
    return run(sys.executable, str(ROOT / "tests/conformance/mtp1.py"), *words, data=data)


def is_compressed(path):
    return "zstd" in path.name or "jpeg" in path.name


class Vectors(unittest.TestCase):
    def test_there_are_enough(self):
        self.assertGreaterEqual(len(VALID), 40)
        self.assertGreaterEqual(len(INVALID), 60)

    def test_files_are_what_make_writes(self):
        made = run(sys.executable, str(ROOT / "spec/vectors/make.py"), "--check")
        self.assertEqual(made.returncode, 0, made.stdout.decode())

    def test_hc_reads_valid(self):
        for path in VALID:
            with self.subTest(path.name):
                shown = hc("cat", "--json", str(path))
                self.assertEqual(shown.stderr, b"")
                self.assertEqual(shown.stdout.decode(), path.with_suffix(".json").read_text())

    def test_python_reads_valid(self):
        for path in VALID:
            with self.subTest(path.name):
                with path.open("rb") as stream:
                    shown = "".join(mtp1.to_json(message) + "\n" for message in mtp1.read(stream))
                wanted = path.with_suffix(".json").read_text()
                if is_compressed(path):
                    wanted = re.sub(r'"elements":.*}', '"elements":null}', wanted)
                self.assertEqual(shown, wanted)

    def test_valid_is_canonical_unless_loose(self):
        for path in VALID:
            with self.subTest(path.name):
                data = path.read_bytes()
                again = hc("cat", "--raw", data=data).stdout
                self.assertEqual(again, python("canon", data=data).stdout)
                if is_compressed(path) or not path.stem.endswith("_loose"):
                    self.assertEqual(again, data)
                else:
                    self.assertNotEqual(again, data)

    def test_hc_refuses_invalid(self):
        for path in INVALID:
            with self.subTest(path.name):
                shown = hc("cat", "--json", str(path))
                error = shown.stderr.decode()
                self.assertEqual(shown.returncode, 1)
                self.assertEqual(error.count("\n"), 1, error)
                found = re.search(r": (R\d+) (\w+): .*, at byte (\d+)$", error.strip())
                self.assertTrue(found, error)
                told = {"rule": found[1], "field": found[2], "byte": int(found[3])}
                told["messages"] = shown.stdout.count(b"\n")
                self.assertEqual(told, json.loads(path.with_suffix(".json").read_text()))

    def test_python_refuses_invalid(self):
        for path in INVALID:
            if path.name.startswith(("R36", "R37")):
                continue  # a basic reader does not decompress
            with self.subTest(path.name):
                told = json.loads(python("refusal", str(path)).stdout)
                self.assertEqual(told, json.loads(path.with_suffix(".json").read_text()))


class RandomMessages(unittest.TestCase):
    def test_hc_reads_what_python_writes(self):
        for seed in SEEDS:
            with self.subTest(seed):
                data = python("random", str(seed), str(COUNT)).stdout
                self.assertTrue(hc("cat", "--raw", data=data).stdout == data)
                shown = hc("cat", "--json", data=data)
                self.assertEqual(shown.stderr, b"")
                self.assertTrue(shown.stdout == python("json", data=data).stdout)

    def test_both_read_loose_spellings_alike(self):
        for seed in SEEDS:
            with self.subTest(seed):
                data = python("random", str(seed), str(COUNT), "--loose").stdout
                canonical = python("random", str(seed), str(COUNT)).stdout
                self.assertNotEqual(len(data), len(canonical))
                shown = hc("cat", "--raw", data=data)
                self.assertEqual(shown.stderr, b"")
                self.assertTrue(shown.stdout == python("canon", data=data).stdout)

    def test_both_refuse_damaged_messages_alike(self):
        """A byte changed at random: both refuse at the same rule and byte, or both read the same."""
        rng = mtp1.random.Random(7)
        for i in range(300):
            data = bytearray(b"".join(mtp1.write(mtp1.random_message(rng)) for _ in range(3)))
            at = rng.randrange(len(data))
            data[at] = rng.choice((rng.randrange(256), 32, 10, 45, 48, 57))
            with self.subTest(i):
                shown = hc("cat", "--json", data=bytes(data))
                found = re.search(
                    r": (R\d+) (\w+): .*, at byte (\d+)$", shown.stderr.decode().strip()
                )
                told = {}
                if shown.returncode != 0:
                    told = {"rule": found[1], "field": found[2], "byte": int(found[3])}
                    told["messages"] = shown.stdout.count(b"\n")
                self.assertEqual(told, json.loads(python("refusal", data=bytes(data)).stdout))


if __name__ == "__main__":
    HC = sys.argv.pop(1)
    unittest.main()
