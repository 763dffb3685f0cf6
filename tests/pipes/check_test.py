#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""hc check on broken graphs: what it says of them is pinned beside lib/graph, and here where."""

import os
import unittest

from harness import DATA, Pipes, ROOT

# Graphs with a blank line between them; a line ends with #! for each problem that it has.
BROKEN = ROOT / "tests/pipes/broken_graphs.txt"
MACROS = {
    "ACTOR": '[modules.actor]\nprogram = "./actor"',
    "LINK": '[modules.camera]\n[modules.brightness]\ninputs.image = { from = "camera.left"',
}
LINKED = '[modules.camera]\n[modules.brightness]\ninputs.image = "camera.left"\n'
# Problems of the whole file, which are said of a line that cannot be marked.
OTHER = {
    "": "g.toml:1: a graph needs a table [modules.NAME] for each of its modules",
    "[modules.camera\n": "g.toml:2: Error while parsing",
    'x = "\n': "g.toml:2: a quote is missing",
    'x = "': "g.toml:2: a quote is missing",
    'x = "\x01"\n': "g.toml:2: Error while parsing string: unescaped control characters",
    "x = relay\n": "g.toml:2: no such value; a string needs quotes",
    'x = ["a, "b"]\n': "g.toml:2: a list lacks a comma, a quote",
    "x = { a = 1\n b = 2 }\n": "g.toml:2: a table in braces is one line",
    "[modules.camera]\n[modules.camera]\n": "g.toml:3: Error while parsing",
}
TYPE = '{"type":"table","components":1,"scalar":"f64","width":0,"height":0,"coord":0}'
FOCUS = TYPE.replace("f64", "i32")
POSE = TYPE.replace("table", "transformation")


def program(inputs, outputs, more=""):
    """A program that does nothing but describe itself."""
    return """#!/bin/sh
echo '{"inputs":[%s],"outputs":[%s],"parameters":[]%s}'
""" % (
        inputs,
        outputs,
        more,
    )


def port(name, kind=TYPE, more=""):
    return '{"name":"%s","types":[%s]%s}' % (name, kind, more)


CONTROL = ',"control":true'
PROGRAMS = {
    "relay": program(port("in"), port("out")),
    "actor": program(port("command", more=',"actor":true'), port("pose", POSE), CONTROL),
    "workspace": program(port("bids"), port("focus", FOCUS), CONTROL),
    "tcp": program(port("in"), port("out"), ',"transports":["tcp","tcp-listen"]'),
    "unix": program(port("in"), port("out"), ',"transports":["unix","unix-listen"]'),
    "tcp_control": program("", "", CONTROL + ',"transports":["tcp","tcp-listen"]'),
}
LIAR = '#!/bin/sh\necho \'{"inputs":[{}],"outputs":[{"name":3,"types":[]}],"parameters":"none"}\'\n'


class Check(Pipes):
    def write_programs(self):
        for name, text in PROGRAMS.items():
            self.write(name, text, 0o755)
        self.write("liar", LIAR, 0o755)
        self.write("plain", "")
        self.write("part.toml", 'version = 1\n[modules.relay]\nprogram = "./relay"\n')

    def refuse(self, text):
        """What is said of a broken graph, the same by check and run."""
        self.write("g.toml", "version = 1\n" + text)
        said = {}
        for verb in "check", "run":
            self.assertEqual(self.shell("hc %s g.toml" % verb, 2), "")
            begin = "hc %s: error: " % verb
            lines = self.err.splitlines()
            self.assertTrue(all(line.startswith(begin) for line in lines), (text, self.err))
            said[verb] = [line[len(begin) :] for line in lines]
        self.assertEqual(said["check"], said["run"])
        return said["check"]

    def test_every_broken_graph_is_refused_line_by_line_and_not_run(self):
        self.write_programs()
        graphs = BROKEN.read_text().strip("\n").split("\n\n")
        self.assertGreaterEqual(sum(text.count(" #!") for text in graphs), 130)
        for text in graphs:
            for macro, meaning in MACROS.items():
                text = text.replace(macro, meaning)
            wanted = [
                "g.toml:%d" % number
                for number, line in enumerate(text.splitlines(), 2)
                for _ in line.split(" #!")[1:]
            ]
            said = self.refuse(text + "\n")
            self.assertEqual([line.split(": ")[0] for line in said], wanted, (text, said))

    def test_problems_of_the_whole_file_are_one_line(self):
        for text, wanted in OTHER.items():
            said = self.refuse(text)
            self.assertEqual(len(said), 1, said)
            self.assertTrue(said[0].startswith(wanted), said)

    def test_right_graphs_are_counted(self):
        self.environment["HC_DATA"] = DATA
        included = {
            "real_head.toml",
            "simulated_head.toml",
        }  # wants the workspace of who includes it
        for graph in sorted(set(os.listdir(ROOT / "graphs")) - included):
            out = self.shell("hc check %s/graphs/%s" % (ROOT, graph))
            self.assertRegex(out, r"\.toml: [0-9]+ modules?, [0-9]+ links?: no problems found\n$")

    def test_warns_of_a_missing_file(self):
        self.write("there.jpg", "")
        graph = "version = 1\n[modules.camera]\nparameters = { source = '%s' }\n"
        for source, problem in (
            ("nofile.jpg", "does not exist"),
            ("none/nofile.mp4", "does not exist"),
            ("there.jpg", ""),
            ("http://robot/a.jpg", ""),
            ("/dev/video99", ""),
        ):
            with self.subTest(source):
                self.write("g.toml", graph % source)
                self.shell("hc check g.toml")
                expected = "hc check: warning: camera: parameter source: %s %s\n" % (
                    source,
                    problem,
                )
                self.assertEqual(self.err, expected if problem else "")

    def test_no_shipped_graph_names_a_file_to_write(self):
        for graph in (ROOT / "graphs").glob("*.toml"):
            self.assertNotRegex(graph.read_text(), r"(?m)^[^#]*(\bsave\b|\bfile:)")

    def test_a_real_head_has_the_tasks_of_the_simulated_one(self):
        self.environment["HC_HEAD"] = "real_head.toml"
        self.assertIn(": no problems found", self.shell("hc check %s/graphs/head.toml" % ROOT))

    def test_errors_of_an_included_file_name_it_and_programs_are_sought_beside_it(self):
        os.mkdir(self.path("parts"))
        self.write("parts/relay", PROGRAMS["relay"], 0o755)
        ring = 'version = 1\n[modules.a]\nprogram = "./relay"\n[modules.b]\nprogram = "./relay"\n'
        self.write("parts/ring.toml", ring + 'inputs.in = "a.out"\n')
        self.write("g.toml", 'version = 1\n[graphs.x]\nfile = "parts/ring.toml"\n')
        self.assertIn("2 modules, 1 link: no problems", self.shell("hc check g.toml"))
        self.write("parts/ring.toml", ring + 'inputs.in = "c.out"\n')
        self.shell("hc check g.toml", 2)
        self.assertEqual(
            self.err, 'hc check: error: parts/ring.toml:6: no module "x_c", did you mean "x_a"?\n'
        )

    def test_what_is_no_text_file_is_reported_in_one_line(self):
        for verb in "check", "run":
            self.shell("hc %s ." % verb, 1)
            self.assertEqual(self.err, "hc %s: System: .: is a folder, not a file\n" % verb)
            self.write("latin.toml", b"[modules.camera]\n# \xe4\n")
            self.shell("hc %s latin.toml" % verb, 2)
            self.assertEqual(
                self.err,
                "hc %s: error: latin.toml:2: this line is not UTF-8\n" % verb,
            )
            self.write("part.toml", "[modules\n")
            self.shell("hc %s part.toml --set camera.width=3" % verb, 2)
            self.assertEqual(len(self.err.splitlines()), 1, self.err)

    def test_settings_are_checked_too(self):
        self.write("g.toml", "version = 1\n" + LINKED)
        self.shell("hc check g.toml --set camera.width=-1 --set camra.width=2", 2)
        self.assertEqual(
            self.err.splitlines(),
            [
                'hc check: error: --set: no module "camra" in g.toml, did you mean "camera"?',
                'hc check: error: --set: module camera: parameter width: "-1" is not from 0 to 65535',
            ],
        )

    def test_the_last_line_of_a_program_that_cannot_describe_itself_is_shown(self):
        self.write("relay", "#!/bin/sh\necho one >&2\necho no numpy here >&2\nexit 3\n", 0o755)
        self.write("g.toml", 'version = 1\n[modules.a]\nprogram = "./relay"\n')
        self.shell("hc check g.toml", 2)
        self.assertIn("relay --describe failed with status 3: no numpy here; ", self.err)
        self.write("relay", "#!/bin/sh\nexit 3\n", 0o755)
        self.shell("hc check g.toml", 2)
        self.assertIn("status 3; see spec/module.md for the description of a program", self.err)


if __name__ == "__main__":
    unittest.main()
