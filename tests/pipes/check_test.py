#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""hc check on broken graphs: each line that is wrong ends with #! and what is to be said of it."""

import os
import pathlib
import unittest

from harness import DATA, Pipes, ROOT

LINK = '[[links]]\nfrom = "camera.left"\nto = "brightness.image"\n'
LINKED = "[modules.camera]\n[modules.brightness]\n" + LINK

BROKEN = [
    # The file.
    "",  # see WHOLE_FILE
    "[modules.camera\n",
    'x = "\n',
    "[modules.camera]\n[modules.camera]\n",
    "a.b.c.d.e.f.g.h.i.j.k.l.m.n.o.p.q.r = 1 #! a key has at most 16 dots, and as many brackets may"
    " stand in one another\n",
    '[modules.camera]\nparameters.source = "\\u007e" #! write ~ itself, not its \\u escape\n',
    'module = 1 #! no key "module" at the top of a graph, did you mean "modules"?\n',
    '[modules.camera]\n[graph] #! no key "graph" at the top of a graph\n',
    "modules = 3 #! a graph has a table [modules.NAME] for each module\n",
    # Modules.
    '[modules.Camera] #! a module\'s name is snake_case, not "Camera"\nprogram = "camera"\n',
    '[modules."two words"] #! a module\'s name is snake_case, not "two words"\nprogram = "camera"\n',
    "[modules]\ncamera = 3 #! a module is a table [modules.camera]\n",
    '[modules.camera]\nprogramme = "x" #! no key "programme" in module camera, did you mean'
    ' "program"?\n',
    '[modules.a] #! no program "camra", did you mean "camera"?\nprogram = "camra"\n',
    '[modules.camera]\nprogram = 3 #! "program" is a string\n[modules.b] #! no program "b"\n',
    '[modules.a] #! no program "./nowhere"\nprogram = "./nowhere"\n',
    '[modules.a] #! ./plain may not be executed\nprogram = "./plain"\n',
    "[modules.a] #! module a: /bin/true --describe prints no description of a module\n"
    'program = "/bin/true"\n',
    '[modules.a] #! module a: /bin/false --describe failed with status 1\nprogram = "/bin/false"\n',
    "[modules.a] #! module a: ./liar --describe prints no description of a module\n"
    'program = "./liar"\n',
    # Parameters.
    '[modules.camera]\nparameters = 3 #! "parameters" is a table\n',
    "[modules.camera]\nparameters.width = [1] #! a parameter is a string, a number, true or false\n",
    '[modules.camera]\nparameters.sources = "a" #! module camera has no parameter "sources", did you'
    ' mean "source"?\n',
    '[modules.camera]\nparameters.width = -1 #! module camera: parameter width: "-1" is not from 0 to'
    " 65535\n",
    '[modules.camera]\nparameters.width = "wide" #! module camera: parameter width: "wide" is not a'
    " whole number\n",
    '[modules.camera]\nparameters.source = "${NO_SUCH_EYE}" #! the environment has no variable'
    " NO_SUCH_EYE; ${NO_SUCH_EYE:-VALUE} gives a default\n",
    '[modules.camera]\nparameters.source = "${EYE" #! no } after ${\n',
    # Addresses and encodings.
    '[modules.camera]\naddresses = 3 #! "addresses" is a table\n',
    "[modules.camera]\naddresses.left = -1 #! an address is a whole number from 0 to 2147483647\n",
    "[modules.camera]\naddresses.left = 1.5 #! an address is a whole number from 0 to 2147483647\n",
    '[modules.camera]\naddresses.lef = 3 #! module camera has no output "lef", did you mean "left"?\n',
    "[modules.camera]\naddresses.left = 3\naddresses.right = 3 #! address 3 is given twice\n",
    '[modules.camera]\nencodings.left = "gif" #! an encoding is "text", "binary", "zstd" or "jpeg"\n',
    '[modules.brightness]\nencodings.mean = "jpeg" #! module brightness: R21 mean: jpeg is for images'
    " of 1 or 3 components of u8, not table 1 x f64\n",
    # Links.
    "links = 3 #! links are written as [[links]]\n[modules.camera]\n",
    '[modules.camera]\n[[links]] #! "to" is missing\nfrom = "camera.left"\n',
    LINKED.replace('"camera.left"', '"camera" #! "camera" is not MODULE.PORT'),
    LINKED.replace('"camera.left"', '3 #! "from" is a string'),
    LINKED.replace("[[links]]", '[[links]] #! no module "camra", did you mean "camera"?').replace(
        "camera.left", "camra.left"
    ),
    LINKED.replace(
        "[[links]]", '[[links]] #! module camera has no output "lef", did you mean "left"?'
    ).replace("camera.left", "camera.lef"),
    LINKED.replace(
        "[[links]]", '[[links]] #! module brightness has no input "imag", did you mean "image"?'
    ).replace(".image", ".imag"),
    LINKED
    + LINK.replace(
        "[[links]]", "[[links]] #! the link from camera.left to brightness.image is there twice"
    ),
    LINKED + 'via = "x" #! no key "via" in a link\n',
    LINKED + 'keep = "some" #! option keep is all, latest, or how many messages\n',
    LINKED + "keep = 0 #! option keep is all, latest, or how many messages\n",
    LINKED + "keep = 1.5 #! keep is a whole number or a string\n",
    LINKED + "burst = 3 #! option burst wants rate beside it\n",
    LINKED + 'memory = "1M" #! memory is at least 1576960 bytes where it is shared, not 1048576\n',
    '[modules.a]\nprogram = "brightness"\n[modules.view]\n'
    "[[links]] #! a.mean gives table 1 x f64, view.image takes rgb_image 3 x u8 or intensity_image 1"
    " x u8\n"
    'from = "a.mean"\nto = "view.image"\n',
    # Several at once, and a loop.
    "[modules.camera]\nparameters = { width = -1, hight = 3 } #! module camera has no parameter"
    ' "hight", did you mean "height"? #! module camera: parameter width: "-1" is not from 0 to 65535'
    '\n[[links]] #! no module "view"\nfrom = "camera.left"\nto = "view.image"\n',
    '[modules.relay]\nprogram = "./relay"\n[[links]] #! a loop without a rate: relay -> relay; give'
    ' one of its links a rate, as rate = 30\nfrom = "relay.out"\nto = "relay.in"\n',
]
# What the reader of TOML says is its own affair; and a file without lines has nobody to say it.
OTHER = {
    BROKEN[0]: "g.toml:1: a graph has a table [modules.NAME] for each module",
    BROKEN[1]: "g.toml:1: Error while parsing",
    BROKEN[2]: "g.toml:1: Error while parsing",
    BROKEN[3]: "g.toml:2: Error while parsing",
}
TYPE = '{"type":"table","components":1,"scalar":"f64","width":0,"height":0,"coord":0}'
RELAY = """#!/bin/sh
echo '{"name":"relay","inputs":[{"name":"in","types":[%s]}],"outputs":[{"name":"out","types":[%s]}],"parameters":[]}'
""" % (
    TYPE,
    TYPE,
)
LIAR = '#!/bin/sh\necho \'{"inputs":[{}],"outputs":[{"name":3,"types":[]}],"parameters":"none"}\'\n'


def wanted_lines(text):
    if text in OTHER:
        return [OTHER[text]]
    return [
        "g.toml:%d: %s" % (number, what.strip())
        for number, line in enumerate(text.splitlines(), 1)
        for what in line.split(" #! ")[1:]
    ]


class Check(Pipes):
    def write(self, name, text, mode=0o644):
        path = pathlib.Path(self.path(name))
        path.write_text(text)
        path.chmod(mode)

    def refuse(self, verb, text):
        self.write("g.toml", text)
        out = self.shell("hc %s g.toml" % verb, 2)
        self.assertEqual(out, "")
        lines = self.err.splitlines()
        for said, wanted in zip(lines, wanted_lines(text)):
            self.assertEqual(
                said[: len("hc %s: Usage: %s" % (verb, wanted))],
                "hc %s: Usage: %s" % (verb, wanted),
                text,
            )
        self.assertEqual(len(lines), len(wanted_lines(text)), (text, self.err))
        return lines

    def test_every_broken_graph_is_refused_line_by_line_and_not_run(self):
        self.write("relay", RELAY, 0o755)
        self.write("liar", LIAR, 0o755)
        self.write("plain", "")
        self.assertGreaterEqual(len(set(BROKEN)), 40)
        for text in BROKEN:
            said = self.refuse("check", text)
            run = self.refuse("run", text)
            self.assertEqual([line[len("hc check") :] for line in said], [x[6:] for x in run])

    def test_right_graphs_are_counted(self):
        self.environment["HC_DATA"] = DATA
        for graph in sorted(os.listdir(ROOT / "graphs")):
            out = self.shell("hc check %s/graphs/%s" % (ROOT, graph))
            self.assertRegex(out, r"\.toml: [0-9]+ modules?, [0-9]+ links?: nothing is wrong\n$")

    def test_settings_are_checked_too(self):
        self.write("g.toml", LINKED)
        self.shell("hc check g.toml --set camera.width=-1 --set camra.width=2", 2)
        self.assertEqual(
            self.err.splitlines(),
            [
                'hc check: Usage: --set: no module "camra" in g.toml, did you mean "camera"?',
                'hc check: Usage: --set: module camera: parameter width: "-1" is not from 0 to 65535',
            ],
        )


if __name__ == "__main__":
    unittest.main()
