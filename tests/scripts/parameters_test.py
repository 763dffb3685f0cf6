#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A parameter that a module looks at only in its on_start is declared `fixed`.

It could be set while the module runs otherwise, and nothing would come of it.
"""

import pathlib
import re
import unittest

MODULES = pathlib.Path(__file__).parents[2] / "modules"
DECLARATION = re.compile(r"(\w+) =\s*module\.parameter\(")


def end_of_call(text, begin):
    """Where the parenthesis closes that is open at `begin`; strings may hold others."""
    depth = 1
    for found in re.compile(r'"(?:\\.|[^"\\])*"|[()]').finditer(text, begin):
        depth += {"(": 1, ")": -1}.get(found[0], 0)
        if depth == 0:
            return found.end()
    raise ValueError("no end of a call")


def read_at_start_alone(sources):
    """Names of the parameters that are not fixed, and used in on_start and nowhere else."""
    running, starting, names = "", "", []
    for text in sources:
        for found in re.finditer(r"module\.on_start\(", text):
            starting += text[found.end() : end_of_call(text, found.end())]
            text = text.replace(text[found.start() : end_of_call(text, found.end())], "", 1)
        for found in DECLARATION.finditer(text):
            if ".fixed = true" not in text[found.end() : end_of_call(text, found.end())]:
                names.append(found[1])
        running += DECLARATION.sub("", text)

    def uses(name, text):
        # As *name or name->, or handed on, as in every(rate, …).
        return re.search(r"(\*(\w+\.)?|[(, ])%s\b(?! =)(->|[^\w.:])" % name, text)

    without_strings = re.sub(r'"(?:\\.|[^"\\])*"|//.*', "", running)
    return [name for name in names if uses(name, starting) and not uses(name, without_strings)]


class Parameters(unittest.TestCase):
    def test_of_a_module_are_fixed_or_looked_at_while_it_runs(self):
        self.assertEqual(
            read_at_start_alone(
                [
                    'auto a = module.parameter("a", 1, "(", "doc");'
                    'auto b = module.parameter("b", 1, "", "", {.fixed = true});'
                    'auto c = module.parameter("c", 1, "", "");'
                    "module.on_start([&] { use(*a, *b, *c); });"
                    "module.on(in, [&] { use(*c); });"
                ]
            ),
            ["a"],
        )
        for module in sorted(MODULES.iterdir()):
            if not module.is_dir():
                continue
            sources = [path.read_text() for path in [*module.glob("*.h"), *module.glob("*.cpp")]]
            with self.subTest(module.name):
                self.assertEqual(read_at_start_alone(sources), [])


if __name__ == "__main__":
    unittest.main()
