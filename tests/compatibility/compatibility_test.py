#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What earlier versions wrote is read, as doc/compatibility.md promises: the folders here, one of each
version, which `make` has written.

    compatibility_test.py BUILD_FOLDER [TEST …]
"""

import json
import pathlib
import shutil
import sys
import unittest

HERE = pathlib.Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "pipes"))

from harness import Pipes, messages_of  # noqa: E402

VERSIONS = sorted(path for path in HERE.iterdir() if path.is_dir())
MEANS = "recording/brightness.mean.mtp"
MOST_LOSS = 12  # by JPEG, of 255


def numbers_of(elements):
    """The numbers of nested lists."""
    if not isinstance(elements, list):
        return [elements]
    return [number for each in elements for number in numbers_of(each)]


class Compatibility(Pipes):
    def in_each(self, check):
        """Calls a check in a copy of the folder of each version."""
        self.assertTrue(VERSIONS)
        for version in VERSIONS:
            with self.subTest(version.name):
                shutil.copytree(version, self.folder.name, dirs_exist_ok=True)
                check(version)

    def test_messages_in_each_encoding(self):
        def check(version):
            paths = sorted(version.glob("messages/*.mtp"))
            self.assertEqual(len(paths), 6)
            for path in paths:
                same = path if path.with_suffix(".json").exists() else path.with_stem("text")
                kept = map(json.loads, same.with_suffix(".json").read_text().splitlines())
                now = self.shell("hc cat --json messages/" + path.name).splitlines()
                for one, other in zip(map(json.loads, now), kept, strict=True):
                    if path != same:
                        self.assertEqual(one["encoding"], path.stem)
                        for key in ("encoding", "info", "ttl"):
                            other[key] = one[key]
                    if path.stem == "jpeg":
                        pairs = zip(*(numbers_of(each.pop("elements")) for each in (one, other)))
                        self.assertLessEqual(max(abs(a - b) for a, b in pairs), MOST_LOSS)
                    self.assertEqual(one, other)

        self.in_each(check)

    def test_recordings(self):
        def check(_):
            self.assertIn("stream", self.shell("hc info recording.mcap"))
            for stream in ("brightness.mean", "camera.left"):
                # Of two runs, at different times.
                one, other = (
                    [json.loads(line)["elements"] for line in self.shell(command).splitlines()]
                    for command in (
                        "hc cat --json 'recording.mcap?stream=%s'" % stream,
                        "hc cat --json recording/%s.mtp" % stream,
                    )
                )
                self.assertEqual(len(one), 3)
                self.assertEqual(one, other)

        self.in_each(check)

    def test_graph_files(self):
        def check(_):
            for name in ("gaze.mtp", "stops.mtp"):  # read by links of check.toml
                self.write(name, "")
            for name in ("check.toml", "run.toml"):
                self.assertIn("no problems found", self.shell("hc check " + name))
            self.shell("rm -f out.mtp; hc run run.toml --quiet")
            now, kept = (messages_of(self.read(name)) for name in ("out.mtp", MEANS))
            self.assertEqual(len(kept), 3)
            self.assertEqual([each.rows for each in now], [each.rows for each in kept])

        self.in_each(check)

    def test_descriptions_of_modules(self):
        def check(_):
            for name in ("arm", "chooser", "eye", "task"):
                described = json.loads(self.shell("./" + name))
                self.assertEqual(json.loads(self.shell("hc describe ./" + name)), described)
                ports = self.shell("hc ports ./" + name)
                for port in described["inputs"] + described["outputs"]:
                    self.assertIn(port["name"], ports)

        self.in_each(check)

    def test_traces(self):
        def check(_):
            for recording in ("recording", "recording.mcap"):
                command = (
                    "hc trace brightness.image --json --graph run.toml --recording " + recording
                )
                path = json.loads(self.shell(command))["paths"][0]
                names = [step["module"] for step in path["steps"]]
                self.assertEqual(names, ["camera", "invert", "brightness"])
                out = self.shell("hc replay %s --graph run.toml --check" % recording)
                self.assertIn("brightness.mean: 3 messages, the same", out)
            # An output got another link while it ran.
            self.assertIn("linked mean ", self.read("changed/brightness.trace.mtp"))
            out = self.shell("hc replay changed --graph changed.toml --check")
            self.assertRegex(out, "brightness.mean: [0-9]+ messages, the same")

        self.in_each(check)


if __name__ == "__main__":
    unittest.main()
