#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks every file: its licence line, its size, its links, and no TODO(now). Prints FILE:LINE."""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).parents[1]
SOURCES = (".h", ".cpp", ".py", ".sh", ".cmake", ".awk", ".toml")
LINK = re.compile(r"\]\(([^)#:]+)(#[^)]*)?\)")
INCLUDE = re.compile(r'^#include [<"](.+)[>"]', re.M)
HERE = pathlib.Path(__file__).relative_to(ROOT)


def budgets():
    lines = (ROOT / "scripts/budgets.txt").read_text().splitlines()
    return {k: int(v) for k, v in (line.split() for line in lines if line and line[0] != "#")}


def stream_peer_lines():
    """The lines of what a peer needs that speaks MTP over streams: its links, and all they include."""
    lib = ROOT / "lib"
    link = lib / "hc/link"
    left = [link / "link.h", link / "table.cpp", link / "wait_set.h", *link.glob("stream/*.cpp")]
    found = {}
    while left:
        path = left.pop()
        is_other = path.parent.name == "shm" or path.stem.endswith("_test")
        if path in found or is_other or not path.is_file():
            continue
        text = path.read_text()
        found[path] = len(text.splitlines())
        left += [path.with_suffix(".cpp"), *(lib / name for name in INCLUDE.findall(text))]
    return sum(found.values())


def same_names():
    """Types of two modules with one name: the tests of all modules are one program."""
    types = {}
    for path in sorted((ROOT / "modules").glob("*/*")):
        if path.suffix not in (".h", ".cpp") or path.name == "main.cpp":
            continue
        text = re.sub(r"^namespace.*?^}  // namespace", "", path.read_text(), flags=re.M | re.S)
        for name in re.findall(r"^(?:class|struct|enum class) (\w+)\b[^;]*$", text, re.M):
            first = types.setdefault(name, path)
            if first.parent != path.parent:
                yield "%s: %s is also in %s" % (path.relative_to(ROOT), name, first.parent.name)


def problems():
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, stdout=-1, check=True).stdout.decode()
    budget, suppressions = budgets(), 0
    for name in listed.splitlines():
        path = ROOT / name
        local = pathlib.Path(name)
        if not path.is_file() or "corpus" in local.parts or "vectors" in local.parts[:-1]:
            continue
        is_source = path.suffix in SOURCES or local.name == "CMakeLists.txt"
        is_script = not path.suffix and path.read_bytes()[:2] == b"#!"
        if is_source or is_script:
            lines = path.read_text().splitlines()
            if not any("SPDX-License-Identifier: Apache-2.0" in line for line in lines[:3]):
                yield "%s:1: no licence line" % name
            if len(lines) > budget["largest_file"]:
                yield "%s: %d lines, at most %d" % (name, len(lines), budget["largest_file"])
            for number, line in enumerate(lines, 1):
                if "TODO(now)" in line and local != HERE:
                    yield "%s:%d: TODO(now)" % (name, number)
                suppressions += "NOLINT" in line and local != HERE
        elif path.suffix == ".md":
            is_code = False
            for number, line in enumerate(path.read_text().splitlines(), 1):
                is_code ^= line.startswith("```")
                for match in () if is_code else LINK.finditer(line):
                    if not (path.parent / match[1]).exists():
                        yield "%s:%d: there is no %s" % (name, number, match[1])
    yield from same_names()
    if suppressions > budget["tidy_suppressions"]:
        yield "%d NOLINT, at most %d" % (suppressions, budget["tidy_suppressions"])
    readme = len((ROOT / "README.md").read_text().splitlines())
    if readme > budget["readme_lines"]:
        yield "README.md: %d lines, at most %d" % (readme, budget["readme_lines"])
    core = (ROOT / "scripts/packages/core.txt").read_text().splitlines()
    packages = sum(not line.startswith("#") for line in core)
    lines = stream_peer_lines()
    if lines > budget["stream_peer_lines"]:
        yield "a peer over streams needs %d lines, at most %d" % (
            lines,
            budget["stream_peer_lines"],
        )
    if packages > budget["core_packages"]:
        yield "the core needs %d packages, at most %d" % (packages, budget["core_packages"])


if __name__ == "__main__":
    found = list(problems())
    print("\n".join(found) if found else "files: licence, sizes and links are right")
    sys.exit(1 if found else 0)
