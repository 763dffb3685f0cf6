#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The site of the documents is built without a warning and without a dead link, and has every public
name of C++ and Python."""

import importlib.machinery
import importlib.util
import inspect
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
MEMBERS = ("function", "variable", "typedef", "enum")


def load_script(name):
    sys.path.insert(0, str(ROOT / "scripts"))
    loader = importlib.machinery.SourceFileLoader(name, str(ROOT / "scripts" / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


def inventory():
    """The names that the site has: {"cpp": …, "py": …}."""
    data = (BUILD / "docs/objects.inv").read_bytes().split(b"\n", 4)[4]
    names = {}
    for line in zlib.decompress(data).decode().splitlines():
        name, role, _, _, _ = line.rsplit(" ", 4)
        names.setdefault(role.split(":")[0], set()).add(name)
    return names


def public_names():
    """The names in the public headers, as Doxygen has read them."""
    for path in sorted((BUILD / "docs_work/xml").glob("*.xml")):
        for compound in ElementTree.parse(path).getroot().iter("compounddef"):
            kind = compound.get("kind")
            if kind not in ("class", "struct", "namespace") or compound.get("prot") == "private":
                continue
            scope = re.sub("(<) | (>)", r"\1\2", compound.findtext("compoundname"))
            if kind != "namespace":
                yield scope
            for member in compound.iter("memberdef"):
                if member.get("kind") in MEMBERS and member.get("prot") == "public":
                    name = "%s::%s" % (scope, member.findtext("name"))
                    yield name
                    for value in member.iter("enumvalue"):
                        yield "%s::%s" % (name, value.findtext("name"))


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        for program in ("doxygen", "sphinx-build"):
            if not shutil.which(program):
                raise unittest.SkipTest("%s is not installed" % program)
        command = [str(ROOT / "scripts/build_docs"), str(BUILD)]
        cls.built = subprocess.run(command, stdout=-1, stderr=-2, text=True)

    def test_it_is_built_without_a_warning_or_a_dead_link(self):
        self.assertEqual(self.built.returncode, 0, self.built.stdout)
        for name in ("index", "doc/tutorial", "spec/mtp-1", "api/cpp", "api/python"):
            self.assertTrue((BUILD / "docs" / (name + ".html")).exists(), name)

    def test_it_has_every_public_header(self):
        headers = (BUILD / "public_headers.txt").read_text().split()
        self.assertGreater(len(headers), 50)
        for header in headers:
            folder = str(pathlib.PurePath(header).parent).removesuffix("/mcap").replace("/", "_")
            page = (BUILD / ("docs/api/libraries/%s.html" % folder)).read_text()
            self.assertIn("&lt;%s&gt;" % header, page)

    def test_it_has_every_public_name_of_cpp(self):
        names = set(public_names())
        self.assertGreater(len(names), 1000)
        self.assertTrue({"hc::Module::on", "hc::Result", "hc::Code::Malformed"} <= names)
        self.assertEqual(sorted(names - inventory()["cpp"]), [])

    def test_it_has_every_public_name_of_python(self):
        sys.path.insert(0, str(BUILD / "python"))
        package = __import__("hypercolumn")
        names = {"hypercolumn." + name for name in package.__all__}
        for name in package.__all__:
            each = getattr(package, name)
            if inspect.isclass(each):
                own = [member for member in vars(each) if not member.startswith("_")]
                names.update("hypercolumn.%s.%s" % (name, member) for member in own)
        self.assertIn("hypercolumn.Module.on", names)
        self.assertEqual(sorted(names - inventory()["py"]), [])


class Links(unittest.TestCase):
    def test_dead_links_are_found(self):
        script = load_script("build_docs")
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "a.html").write_text(
                '<p id="x"><a href="b.html#y"><a href="#x"><a href="https://a.org/b">'
                '<a href="c.html"><a href="b.html#z"><img src="d.png"><a href="https://a b">'
            )
            (folder / "b.html").write_text('<p id="y">')
            found = sorted(script.dead_links(folder))
        dead = ["b.html#z", "c.html", "d.png", "https://a b"]
        self.assertEqual(found, ["a.html: " + each for each in dead])


if __name__ == "__main__":
    unittest.main()
