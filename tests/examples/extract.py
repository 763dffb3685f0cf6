#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the C++ blocks of the README and the documents into a folder: NAME_1.cpp is the first
program of NAME.md, as it is printed; fragments.cpp has the blocks without a main().

    extract.py FOLDER PROGRAM …

The programs are those that CMakeLists.txt builds: another one is an error.
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).parents[2]
# What a fragment needs before and after it, by its first words.
AROUND = {
    "module.on(hc::together(left, right)": (
        """#include <hc/module/module.h>
void compare(const hc::Image& left, const hc::Image& right);
void take_together(hc::Module& module, const hc::Input<hc::ImageKind>& left,
                   const hc::Input<hc::ImageKind>& right) {
""",
        "}\n",
    ),
    "hc::frames::Tree tree": (
        """#include <frames/messages.h>
#include <frames/tree.h>
hc::Result<Eigen::Vector3d> in_world(const Eigen::Isometry3d& T_world_robot,
                                     const Eigen::Isometry3d& T_head_left_eye,
                                     const hc::Message& report, const hc::Message& image,
                                     const Eigen::Vector3d& p_left_eye) {
""",
        "return p_world;\n}\n",
    ),
}
# Programs that are also in the source, apart from the comments before their includes.
COPIES = {
    "api_beside_others_1": "modules/brightness/main.cpp",
    "modules_1": "templates/module/main.cpp",
}
BUILT_ELSEWHERE = ["api_beside_others_1"]
# Documents whose fragments are pieces of files in these folders.
QUOTED = {"adding_a_device": ("drivers/pan_tilt", "modules/pan_tilt", "modules/joystick")}


def blocks(language):
    """The blocks of all documents in a language: [(path, line, text)]."""
    found = []
    for path in [ROOT / "README.md", *sorted(ROOT.glob("doc/*.md"))]:
        text = path.read_text(encoding="utf8")
        for match in re.finditer("^```%s\n(.*?)^```$" % language, text, re.M | re.S):
            found.append((path, text.count("\n", 0, match.start(1)) + 1, match[1]))
    return found


def without_comments(text):
    """A program from its first include on; the name of a template is that in the document."""
    return text[text.index("#include") :].replace("@NAME@", "gauge")


def extracted():
    """Texts of the files by their names without .cpp. Raises ValueError."""
    programs, fragments = {}, []
    for path, line, text in blocks("cpp"):
        marked = '#line %d "%s"\n%s' % (line, path, text)
        if "int main(" in text:
            number = 1 + sum(name.startswith(path.stem + "_") for name in programs)
            name = "%s_%d" % (path.stem, number)
            copy = COPIES.get(name)
            if copy and text != without_comments((ROOT / copy).read_text(encoding="utf8")):
                raise ValueError("%s:%d is not %s" % (path, line, copy))
            programs[name] = marked
            continue
        if path.stem in QUOTED:
            folders = QUOTED[path.stem]
            files = [each for name in folders for each in (ROOT / name).iterdir()]
            if not any(text in each.read_text(encoding="utf8") for each in files):
                raise ValueError("%s:%d is in no file of %s" % (path, line, ", ".join(folders)))
            continue
        around = [each for words, each in AROUND.items() if text.startswith(words)]
        if not around:
            raise ValueError("%s:%d: extract.py does not know what is around it" % (path, line))
        fragments += [around[0][0], marked, around[0][1]]
    for name in BUILT_ELSEWHERE:
        del programs[name]
    return {**programs, "fragments": "".join(fragments)}


def main():
    folder, *programs = sys.argv[1:]
    files = extracted()
    if set(files) != {*programs, "fragments"}:
        raise ValueError("tests/examples/CMakeLists.txt has not these programs: %s" % sorted(files))
    for name, text in files.items():
        path = pathlib.Path(folder, name + ".cpp")
        if not path.exists() or path.read_text(encoding="utf8") != text:
            path.write_text(text, encoding="utf8")


if __name__ == "__main__":
    try:
        main()
    except ValueError as error:
        sys.exit("extract.py: %s" % error)
