#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Two readers, one specification: hc and mtp1.py read every vector and each other's messages.

    conformance_test.py HC

Random messages come from fixed seeds. The folder images/ holds small images that cjpeg made, of
the kinds that hc reads and does not write; their names say which.
"""

import json
import pathlib
import random
import re
import struct
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import mtp1  # noqa: E402
import mtp1_random  # noqa: E402
from mtp1_header import Header  # noqa: E402

ROOT = HERE.parents[1]
VALID = sorted((ROOT / "spec/vectors/valid").glob("*.mtp"))
INVALID = sorted((ROOT / "spec/vectors/invalid").glob("*.mtp"))
COMPRESSED = [path for path in VALID if path.name.startswith(("zstd", "jpeg"))]
IMAGES = sorted((HERE / "images").glob("*.jpg"))
HC = "hc"
SEEDS = (1, 2, 3)
COUNT = 400
DAMAGED = ("R36", "R37")  # rules of compressed elements, behind which hc cat goes on
REFUSED = re.compile(r": (R\d+) (\w+): .*, at byte (\d+)$")


def run(*command, data=b""):
    return subprocess.run(command, input=data, stdout=-1, stderr=-1, timeout=100)


def hc(*words, data=b""):
    return run(HC, *words, data=data)


def python(*words, data=b""):
    return run(sys.executable, str(HERE / "mtp1.py"), *words, data=data)


class Report:
    """What a reader makes of a stream: JSON lines, and how it refuses what follows them."""

    def __init__(self, text, refusal, reason=""):
        self.text, self.refusal, self.reason = text, refusal, reason

    def __eq__(self, other):
        return (self.text, self.refusal) == (other.text, other.refusal)

    def __repr__(self):
        return "%s %s ...%s" % (self.refusal, self.reason, self.text[-200:])


def reported_by_hc(data):
    shown = hc("cat", "--json", data=data)
    text, error = shown.stdout.decode(), shown.stderr.decode().strip()
    if shown.returncode == 0:
        return Report(text, {}, error)
    first = error.split("\n")[0]
    found = REFUSED.search(first)
    goes_on = found and found[1] in DAMAGED
    if shown.returncode != 1 or not found or (first != error and not goes_on):
        return Report(text, None, error)
    refusal = {"rule": found[1], "field": found[2], "byte": int(found[3])}
    refusal["messages"] = text.count("\n")
    return Report(text, refusal, error)


def reported_by_python(data):
    lines = []
    try:
        for message in mtp1.read(data):
            lines.append(mtp1.to_json(message) + "\n")
    except mtp1.Refused as refused:
        return Report("".join(lines), refused.reported(), refused.reason)
    return Report("".join(lines), {})


def wanted(path):
    """What a vector's twin says."""
    text = path.with_suffix(".json").read_text()
    return (text, {}) if path.parent.name == "valid" else json.loads(text)


class Pieces:
    """A stream that gives a few bytes at a time."""

    def __init__(self, data, rng):
        self.data, self.rng = data, rng

    def read1(self, _):
        count = self.rng.randrange(1, 9)
        piece, self.data = self.data[:count], self.data[count:]
        return piece


def npy(scalar, shape, data):
    """A NumPy file."""
    letters = ("<" if scalar[1:] != "8" else "|") + scalar[0] + str(int(scalar[1:]) // 8)
    given = "{'descr': '%s', 'fortran_order': False, 'shape': %s, }" % (letters, shape)
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(given)) + given.encode() + data


def send(header, data, *words):
    """The message that hc makes of a NumPy file or of numbers on its command line."""
    for field in ("src", "dst", "seq", "ttl", "time", "mode", "coord"):
        words = ("--%s=%d" % (field, getattr(header, field)),) + words
    made = hc("send", "--encoding=" + header.encoding, *words, data=data)
    assert made.returncode == 0, made.stderr
    return made.stdout


def send_table(rng, size):
    """A table of about so many random bytes: as we know it, and as hc sends it in zstd."""
    header = mtp1_random.random_header(rng)
    scalar, components = rng.randrange(10), rng.choice((1, 2, 4, 99))
    header.info = 120000 + components * 100 + scalar * 10 + 2
    header.height = rng.choice((1, 2, 5))
    header.width = size // (components * header.height * header.code.size)
    shape = (header.height, header.width, components)
    message = mtp1.Message(header, mtp1_random.random_bytes(rng, header.size))
    data = npy(header.scalar, shape, message.elements)
    return message, send(header, data, "--npy=/dev/stdin")


def send_image(rng):
    """A small random image, grey or in colour, as hc sends it in JPEG."""
    header = mtp1_random.random_header(rng)
    header.info = rng.choice((30303, 40103))
    header.width, header.height = rng.randint(1, 30), rng.randint(1, 20)
    data = mtp1_random.random_bytes(rng, header.size)
    if header.components == 3:
        data = npy("u8", (header.height, header.width, 3), data)
        return send(header, data, "--npy=/dev/stdin")
    words = ("--type=intensity_image", "--scalar=u8", "--width=%d" % header.width, *map(str, data))
    return send(header, b"", *words)


def wrap(image):
    """A message of an image file."""
    frame = re.search(rb"\xff[\xc0\xc2]..\x08(..)(..)(.)", image, re.S)
    height, width, components = (int.from_bytes(number, "big") for number in frame.groups())
    header = Header(info={1: 40103, 3: 30303}[components], width=width, height=height)
    return mtp1.write(mtp1.Message(header, None, image))


class Vectors(unittest.TestCase):
    def test_there_are_enough(self):
        self.assertGreaterEqual(len(VALID), 40)
        self.assertGreaterEqual(len(INVALID), 60)
        self.assertGreaterEqual(len(COMPRESSED), 10)
        self.assertGreaterEqual(len(IMAGES), 8)

    def test_each_rule_that_the_document_names_is_broken_by_a_file(self):
        text = (ROOT / "spec/mtp-1.md").read_text()
        named = re.search(r"each rule that a message can break, ([^(]*)", text)[1]
        spans = re.findall(r"R(\d+) … R(\d+)", named)
        rules = {rule for a, b in spans for rule in range(int(a), int(b) + 1)}
        self.assertEqual(rules, {int(path.name[1:].split("_")[0]) for path in INVALID})

    def test_files_are_what_make_writes(self):
        made = run(sys.executable, str(ROOT / "spec/vectors/make.py"), "--check")
        self.assertEqual(made.returncode, 0, made.stdout.decode())

    def test_both_read_valid(self):
        for path in VALID:
            for given in (reported_by_hc, reported_by_python):
                with self.subTest(path.name, reader=given.__name__):
                    read = given(path.read_bytes())
                    self.assertEqual((read.text, read.refusal), wanted(path))
                    self.assertEqual(read.reason, "")

    def test_both_refuse_invalid(self):
        for path in INVALID:
            for given in (reported_by_hc, reported_by_python):
                with self.subTest(path.name, reader=given.__name__):
                    read = given(path.read_bytes())
                    self.assertEqual(read.refusal, wanted(path), read.reason)

    def test_valid_is_canonical_unless_loose(self):
        for path in VALID:
            with self.subTest(path.name):
                data = path.read_bytes()
                again = hc("cat", "--raw", data=data).stdout
                self.assertEqual(again, b"".join(map(mtp1.write, mtp1.read(data))))
                self.assertEqual(again == data, not path.stem.endswith("_loose"))

    def test_basic_reader_gives_null(self):
        for path in COMPRESSED:
            with self.subTest(path.name):
                data, text = path.read_bytes(), wanted(path)[0]
                messages = list(mtp1.read(data, expand=False))
                shown = "".join(mtp1.to_json(message) + "\n" for message in messages)
                self.assertEqual(shown, re.sub(r'"elements":.*}', '"elements":null}', text))
                self.assertEqual(b"".join(map(mtp1.write, messages)), data)

    def test_pieces_make_no_difference(self):
        rng = random.Random(1)
        for path in VALID + INVALID:
            with self.subTest(path.name):
                data = path.read_bytes()
                self.assertEqual(reported_by_python(Pieces(data, rng)), reported_by_python(data))

    def test_command_line(self):
        path = ROOT / "spec/vectors/valid/stream_mixed.mtp"
        self.assertEqual(python("json", str(path)).stdout.decode(), wanted(path)[0])
        self.assertEqual(python("canon", data=path.read_bytes()).stdout, path.read_bytes())
        self.assertEqual(python("refusal", "--basic", str(path)).stdout, b"{}\n")
        path = ROOT / "spec/vectors/invalid/R7_third_message.mtp"
        self.assertEqual(json.loads(python("refusal", str(path)).stdout), wanted(path))
        refused = python("json", str(path))
        self.assertEqual((refused.returncode, refused.stdout.count(b"\n")), (1, 2))
        loose = python("random", "1", "9", "--loose").stdout
        self.assertEqual(python("canon", data=loose).stdout, python("random", "1", "9").stdout)


class RandomMessages(unittest.TestCase):
    def test_hc_reads_what_python_writes(self):
        for seed in SEEDS:
            with self.subTest(seed):
                data = b"".join(mtp1.random_stream(seed, COUNT))
                self.assertTrue(hc("cat", "--raw", data=data).stdout == data)
                self.assertTrue(reported_by_hc(data) == reported_by_python(data))

    def test_both_read_loose_spellings_alike(self):
        for seed in SEEDS:
            with self.subTest(seed):
                data = b"".join(mtp1.random_stream(seed, COUNT, loose=True))
                canonical = b"".join(mtp1.random_stream(seed, COUNT))
                self.assertNotEqual(data, canonical)
                shown = hc("cat", "--raw", data=data)
                self.assertEqual(shown.stderr, b"")
                self.assertTrue(shown.stdout == canonical)
                self.assertTrue(b"".join(map(mtp1.write, mtp1.read(data))) == canonical)

    def test_both_refuse_damaged_messages_alike(self):
        rng = random.Random(7)
        for i in range(700):
            messages = [mtp1_random.random_message(rng) for _ in range(3)]
            data = b"".join(map(mtp1.write, messages))
            with self.subTest(i):
                self.check_alike(mtp1_random.damage(rng, data))

    def test_python_reads_what_hc_compresses(self):
        rng = random.Random(11)
        for i in range(150):
            with self.subTest(i):
                size = 150000 if i % 75 == 0 else rng.choice((0, 1, 9, 60, 400, 2500))
                sent, data = send_table(rng, size)
                (message,) = mtp1.read(data)
                self.assertEqual(message.header, sent.header)
                self.assertTrue(message.elements == sent.elements)

    def test_both_read_images_alike(self):
        rng = random.Random(13)
        images = [wrap(path.read_bytes()) for path in IMAGES]
        images += [send_image(rng) for _ in range(60)]
        for i, image in enumerate(images):
            with self.subTest(i):
                self.assertEqual(self.check_alike(image), {})

    def test_both_refuse_damaged_compressed_alike(self):
        rng = random.Random(17)
        whole = [path.read_bytes() for path in COMPRESSED]
        whole += [wrap(path.read_bytes()) for path in IMAGES]
        whole += [send_table(rng, rng.choice((9, 60, 400)))[1] for _ in range(50)]
        whole += [send_image(rng) for _ in range(20)]
        for i in range(200):
            (message,) = mtp1.read(rng.choice(whole), expand=False)
            message.compressed = mtp1_random.damage(rng, message.compressed) or b"?"
            with self.subTest(i):
                self.check_alike(mtp1.write(message))

    def check_alike(self, data):
        """Both refuse at the same rule and byte, or read the same; gives the refusal of mtp1.py."""
        shown, read = reported_by_hc(data), reported_by_python(data)
        refusal = read.refusal
        if shown.refusal and refusal and refusal["rule"] in DAMAGED:
            self.assertTrue(shown.text.startswith(read.text))
            shown.text, shown.refusal["messages"] = read.text, refusal["messages"]
        self.assertEqual(shown, read)
        return refusal


if __name__ == "__main__":
    HC = sys.argv.pop(1)
    unittest.main()
