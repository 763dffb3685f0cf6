#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The commands of the README and the documents."""

import pathlib
import re
import unittest

from harness import BUILD, DATA, Pipes, ROOT, free_port


# What a document shows of figures that differ from run to run, and the bounds of what it shows and
# of what is measured.
BOUNDS = [
    (r"RMS error ([\d.]+)°", 0, 10),
    (r"acquired after ([\d.]+) s", 0, 4),
    (r"came back ([\d.]+) times", 0, 5),
    (r"bad pixels ([\d.]+) %", 0, 15),
    (r"character error rate ([\d.]+) %", 0, 0),
    (r"spoken ([\d.]+) s median", 0, 8),
    (r", ([\d.]+) s at most", 0, 8),
]
SEPARATOR = "---- end of a session"
# What `hc run` says besides on a machine that has no time for a module.
OF_LOAD = re.compile(r"\S+: (unresponsive: busy|resumed)|  \d+ dropped \(--links: at which links\)")
# What `hc replay` adds where the recorder was told to end between two messages of a step.
AT_THE_END = re.compile(r", \d+ after the last whole step$")


def shown_sessions(block):
    """The commands of a block up to each piece of shown output, and that output: [(str, [str])]."""
    sessions = [([], [])]
    for line in block.splitlines():
        if line.startswith("# "):
            sessions[-1][1].append(line[2:])
        else:
            if sessions[-1][1]:
                sessions.append(([], []))
            sessions[-1][0].append(line)
    return [("\n".join(commands) + "\n", shown) for commands, shown in sessions]


def is_like(shown, line):
    """Whether a line is the one that is shown, in which "…" stands for any text."""
    for pattern, low, high in BOUNDS:
        if figure := re.search(pattern, shown):
            measured = re.search(pattern, line)
            if not measured or not all(
                low <= float(each[1]) <= high for each in (figure, measured)
            ):
                return False
            shown = shown.replace(figure[0], "…")
    return re.fullmatch(re.escape(shown).replace("…", ".*"), line)


def lines_of(text):
    lines = (AT_THE_END.sub("", line) for line in text.splitlines())
    return [line for line in lines if not OF_LOAD.fullmatch(line)]


def are_like(shown, lines):
    """Whether the lines are those that are shown, in their order; a line "…" stands for any lines."""
    if not shown:
        return not lines
    if shown[0] == "…":
        return any(are_like(shown[1:], lines[i:]) for i in range(len(lines) + 1))
    return bool(lines) and bool(is_like(shown[0], lines[0])) and are_like(shown[1:], lines[1:])


class Comparison(unittest.TestCase):
    """What counts as shown."""

    def test_lines_are_whole_and_in_order(self):
        self.assertTrue(are_like(["a 1", "b …"], ["a 1", "b 2"]))
        self.assertFalse(are_like(["b …", "a 1"], ["a 1", "b 2"]))
        self.assertFalse(are_like(["a"], ["a 1"]))
        self.assertFalse(are_like(["a 1"], ["a 1", "b 2"]))
        self.assertFalse(are_like(["a 1", "b 2"], ["a 1"]))

    def test_omitted_lines_are_marked(self):
        self.assertTrue(are_like(["…", "b"], ["a", "a", "b"]))
        self.assertTrue(are_like(["a", "…"], ["a"]))
        self.assertFalse(are_like(["a", "…", "c"], ["a", "b"]))

    def test_what_a_busy_machine_adds_is_not_compared(self):
        said = (
            "a: started\na: unresponsive: busy\na: resumed\n  2 dropped (--links: at which links)\n"
        )
        self.assertEqual(lines_of(said), ["a: started"])
        said = "x.left: 35 messages, the same, 1 after the last whole step"
        self.assertEqual(lines_of(said), ["x.left: 35 messages, the same"])
        self.assertEqual(
            lines_of("a: unresponsive: stopped by a signal\n  2 dropped\n")[1:], ["  2 dropped"]
        )

    def test_figures_are_within_bounds(self):
        shown = "track_score: RMS error 0.5°, acquired after 0.6 s, …"
        self.assertTrue(is_like(shown, "track_score: RMS error 2°, acquired after 0 s, came"))
        self.assertFalse(is_like(shown, "track_score: RMS error 20°, acquired after 0 s, came"))
        self.assertFalse(is_like(shown, "track_score: RMS error nan°, acquired after 0 s, came"))

    def test_output_belongs_to_the_commands_before_it(self):
        self.assertEqual(
            shown_sessions("a\n# 1\n# 2\nb\nc\n"), [("a\n", ["1", "2"]), ("b\nc\n", [])]
        )


class Documents(Pipes):
    """Every command of the README and the documents, as it is written there, and what it prints."""

    def commands(self, name):
        text = (ROOT / name).read_text()
        text = text.replace("7311", str(free_port()))  # may be somebody else's just now
        blocks = re.findall(r"```sh\n(.*?)```", text, re.S)
        self.assertTrue(blocks)
        return [block for block in blocks if "./dev" not in block]

    def run_document(self, name):
        for folder in ("graphs", "modules", "templates", "python"):
            pathlib.Path(self.path(folder)).symlink_to(ROOT / folder)
        pathlib.Path(self.path("data")).symlink_to(DATA)
        Documents.run_blocks(self, name)

    def run_blocks(self, name):
        for block in self.commands(name):
            with self.subTest(block):
                wrong = Documents.run_block(self, block)
                self.assertFalse(wrong, wrong)

    def run_block(self, block):
        """What it prints other than it shows, in words."""
        sessions = shown_sessions(block)
        separate = "echo %s; echo %s >&2\n" % (SEPARATOR, SEPARATOR)
        script = separate.join(commands for commands, _ in sessions)
        outputs = self.shell("set -e\n" + script).split(SEPARATOR + "\n")
        errors = self.err.split(SEPARATOR + "\n")
        for (commands, shown), out, err in zip(sessions, outputs, errors, strict=True):
            # The two come at the same time, when several programs write them.
            if shown and not any(
                are_like(shown, lines_of(both)) for both in (out + err, err + out)
            ):
                return "\n".join([commands, "shown:", *shown, "printed:", out, err])
        return ""

    def test_readme(self):
        self.run_blocks("README.md")  # in an empty folder

    def test_tutorial(self):
        self.run_document("doc/tutorial.md")

    def test_modules(self):
        self.run_document("doc/modules.md")

    def test_languages(self):
        self.run_document("doc/languages.md")

    def test_adding_a_device(self):
        self.run_document("doc/adding_a_device.md")

    def test_links(self):
        self.run_document("doc/links.md")

    def test_module_contract(self):
        self.run_document("spec/module.md")

    def test_coming_from_ros2(self):
        self.run_document("doc/coming_from_ros2.md")

    def test_routing(self):
        self.run_document("doc/routing.md")

    def test_frames(self):
        self.run_document("doc/frames.md")

    def test_body(self):
        self.run_document("doc/body.md")

    def test_sight(self):
        self.run_document("doc/sight.md")

    def test_head(self):
        self.run_document("doc/head.md")

    def test_recordings(self):
        self.run_document("doc/recordings.md")

    def test_trace(self):
        self.run_document("doc/trace.md")

    def use_python(self):
        if not list(BUILD.glob("python/hypercolumn/_hypercolumn*.so")):
            self.skipTest("the Python package was not built")
        self.environment["PYTHONPATH"] = str(BUILD / "python")

    def test_python(self):
        self.use_python()
        self.run_document("doc/python.md")

    def test_tasks(self):
        self.use_python()
        self.run_document("doc/tasks.md")


if __name__ == "__main__":
    unittest.main()
