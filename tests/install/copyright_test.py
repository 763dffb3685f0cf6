#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The package's copyright file names what is in it: what the page bundles, the headers that are
compiled in, the weights of networks, and the one program that is linked with a library under the GPL.

    copyright_test.py BUILD_FOLDER
"""

import json
import pathlib
import re
import subprocess
import sys
import unittest
from fnmatch import fnmatch

ROOT = pathlib.Path(__file__).parents[2]
TEXT = (ROOT / "cmake/debian_copyright").read_text()
PACKAGES = json.loads((ROOT / "nets/package.json").read_text())["dependencies"]
# Folders of headers by what has their code: our programs, or libraries that these are linked with.
COMPILED_IN = {
    "CLI": "CLI11",
    "Eigen": "Eigen",
    "boost": "Boost",
    "nlohmann": "JSON for Modern C++",
    "pybind11": "pybind11",
    "toml++": "toml++",
}
LINKED = "EGL GL SDL2 apriltag assimp espeak-ng hwy opencv2 openssl tesseract vpx".split()
SYSTEM = "arpa linux net netinet sys".split()


def paragraphs():
    """The paragraphs of the file, each as its fields by their names."""
    for text in re.split(r"\n\n+", TEXT.strip()):
        fields = re.split(r"^([A-Z][\w-]*):", text, flags=re.M)
        yield dict(zip(fields[1::2], (value.rstrip("\n") for value in fields[2::2])))


class Copyright(unittest.TestCase):
    def test_its_form(self):
        first, *rest = paragraphs()
        self.assertIn("Format", first)
        texts = {each["License"].split("\n")[0].strip() for each in rest if "Files" not in each}
        used = set()
        for each in rest:
            if "Files" in each:
                self.assertTrue(each["Copyright"].strip(), each)
                used |= set(each["License"].strip().split(" and "))
        self.assertEqual(used, texts)
        for line in TEXT.splitlines():
            self.assertRegex(line, r"^($| \S| {2,}\S|[A-Z][\w-]*: ?\S)")

    def test_what_the_page_bundles(self):
        script = (BUILD / "modules/web/page/page.js").read_text()
        licences = script[script.rindex("This page contains the following packages.") :]
        found = re.split(r"^(@?[a-z][\w./-]*)\n\n", licences, flags=re.M)[1:]
        bundled = dict(zip(found[::2], found[1::2]))
        self.assertIn("three", bundled)
        (web,) = [each for each in paragraphs() if each.get("Files", "").endswith("/web")]
        named = re.findall(r"^ (\S+) \(Expat, (.*)\)$", web["Comment"], re.M)
        self.assertEqual([name for name, _ in named], sorted(bundled))
        for name, holder in named:
            with self.subTest(name):
                self.assertIn("Permission is hereby granted, free of charge", bundled[name])
                notice = re.search(r"^Copyright (?:©|\(c\)) (.*)$", bundled[name], re.M)[1]
                self.assertTrue(notice.endswith(holder), notice)
                self.assertIn("\n " + notice, web["Copyright"])

    def test_weights_of_networks(self):
        folder = BUILD / "share/hypercolumn/nets"
        weights = {path.name for path in folder.iterdir() if path.suffix in (".tflite", ".bin")}
        self.assertIn("face_recognition.bin", weights)
        notice = (ROOT / "NOTICE").read_text()
        self.assertEqual(set(re.findall(r"^(\w+\.(?:tflite|bin))$", notice, re.M)), weights)
        covered = [each.get("Files", "").strip() for each in paragraphs()]
        for name in weights:
            path = "usr/share/hypercolumn/nets/" + name
            self.assertTrue([one for one in covered if one != "*" and fnmatch(path, one)], name)
        holder = re.search(
            r"^Copyright \(c\) (.*)$", (folder / "LICENSE.face-api").read_text(), re.M
        )
        self.assertRegex(TEXT, r"(?m)^Copyright: %s$" % holder[1])
        for package, version in re.findall(r"(@[\w/-]+) ([\w.]+)", notice):
            self.assertEqual(PACKAGES[package], version.rstrip("."))

    def test_headers_that_are_compiled_in(self):
        own = {path.name for path in (ROOT / "lib").iterdir()} | {"drivers", "gtest"}
        roots = set()
        for folder in ("lib", "drivers", "modules", "python", "tools"):
            for path in (ROOT / folder).rglob("*"):
                if path.suffix in (".h", ".cpp", ".c"):
                    roots |= set(re.findall(r"^#include <([^/>]+)/", path.read_text(), re.M))
        self.assertEqual(roots - own, {*COMPILED_IN, *LINKED, *SYSTEM})
        for name in COMPILED_IN.values():
            self.assertRegex(TEXT, r"(?m)^ .*%s" % re.escape(name))

    def test_the_program_with_a_library_under_the_gpl(self):
        linked = []
        for path in [BUILD / "bin/hc", *(BUILD / "libexec/hypercolumn").iterdir()]:
            needed = subprocess.run(["readelf", "-d", path], stdout=-1, check=True).stdout.decode()
            linked += [path.name] if "[libespeak-ng." in needed else []
        self.assertEqual(linked, ["speak"])
        self.assertRegex(TEXT, r"Files: usr/libexec/hypercolumn/speak\n.*\nLicense: .*GPL-3\+")


if __name__ == "__main__":
    BUILD = pathlib.Path(sys.argv.pop(1))
    unittest.main()
