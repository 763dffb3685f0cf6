#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""hc check on broken graphs: each line that is wrong ends with #! and what is to be said of it."""

import os
import re
import unittest

from harness import DATA, Pipes, ROOT

LINK = '[[links]]\nfrom = "camera.left"\nto = "brightness.image"\n'
LINKED = "[modules.camera]\n[modules.brightness]\n" + LINK
ACTOR = '[modules.actor]\nprogram = "./actor"\n'
TRACK = '[modules.track]\nprogram = "./actor"\nmode = "track"\n[modes]\ntrack = 1\n'
READER = '[modules.read]\nprogram = "./actor"\nmode = "read"\n'
WORKSPACE = '[modules.judge]\nprogram = "./workspace"\n[workspace]\nmodule = "judge"\n'
RELAYS = '[modules.a]\nprogram = "./relay"\n[modules.b]\nprogram = "./relay"\n'
FRAME = ACTOR + '[frames.head]\nparent = "robot"\n'

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
    '[Modules.camera] #! no key "Modules" at the top of a graph, did you mean "modules"?\n',
    "[modules.k\u00e4mera] #! Error while parsing table header: expected ']', saw a character that is"
    ' for strings and comments\nprogram = "camera"\n',
    "modules = 3 #! a graph has a table [modules.NAME] for each module\n",
    # Modules.
    '[modules.Camera] #! a module\'s name is snake_case, not "Camera"\nprogram = "camera"\n',
    '[modules."two words"] #! a module\'s name is snake_case, not "two words"\nprogram = "camera"\n',
    "[modules]\ncamera = 3 #! a module is a table [modules.camera]\n",
    '[modules.camera]\nprogramme = "x" #! no key "programme" in module camera, did you mean'
    ' "program"?\n',
    '[modules.a] #! no program "camra", did you mean "camera"?\nprogram = "camra"\n',
    '[modules.camera]\nprogram = 3 #! "program" is a string\n[modules.b] #! no program "b"\n',
    '[modules.a]\nprogram = 3 #! "program" is a string\n',
    '[modules.a]\nprogram = "" #! "program" is empty\n',
    '[modules."two words"] #! a module\'s name is snake_case, not "two words"\n',
    '[modules.a] #! /etc is a folder, not a program\nprogram = "/etc"\n',
    '[modules.a] #! /dev/null may not be executed\nprogram = "/dev/null"\n',
    '[modules.a] #! no program "./camera"\nprogram = "./camera"\n',
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
    '[modules.camera]\nparameters.source = "${}" #! no name in ${}, which stands for a variable of the'
    " environment\n",
    '[modules.camera]\nparameters.width = "${NO_SUCH_EYE}" #! the environment has no variable'
    " NO_SUCH_EYE; ${NO_SUCH_EYE:-VALUE} gives a default\n",
    # Addresses and encodings.
    '[modules.camera]\naddresses = 3 #! "addresses" is a table\n',
    "[modules.camera]\naddresses.left = -1 #! an address is a whole number from 0 to 2147483647\n",
    "[modules.camera]\naddresses.left = 1.5 #! an address is a whole number from 0 to 2147483647\n",
    '[modules.camera]\naddresses.lef = 3 #! module camera has no port "lef", did you mean "left"?\n',
    "[modules.camera]\naddresses.left = 3\naddresses.right = 3 #! address 3 is given twice\n",
    '[modules.camera]\nencodings.left = "gif" #! an encoding is "text", "binary", "zstd" or "jpeg"\n',
    '[modules.brightness]\nencodings.mean = "jpeg" #! module brightness: R21 mean: jpeg is for images'
    " of 1 or 3 components of u8, not table 1 x f64\n",
    # Whether modules are started again.
    '[modules.camera]\nrestart = "alway" #! "restart" is "never", "failure" or "always", did you mean'
    ' "always"?\n',
    'restart = true #! "restart" is "never", "failure" or "always"\n[modules.camera]\n',
    # Addresses of inputs, addressees, groups and routes.
    ACTOR + "addresses = { command = 7, pose = 7 } #! address 7 is given twice\n",
    "[modules.camera]\naddresses.left = 9\n"
    + ACTOR
    + "addresses.command = 9 #! address 9 is given twice\n",
    ACTOR + 'to.pose = 0 #! "to" is an address from -2147483647 to 2147483647 without 0, or a'
    " name\n",
    ACTOR
    + 'to.pose = "arm" #! no group or input "arm", did you mean "arms"?\n[groups]\narms = []\n',
    ACTOR + 'to.pose = "actor.comand" #! no group or input "actor.comand", did you mean'
    ' "actor.command"?\n',
    ACTOR + 'to.pos = "all" #! module actor has no output "pos", did you mean "pose"?\n',
    '[modules.relay]\nprogram = "./relay"\nto.out = 3 #! module relay cannot have "to": its program'
    " knows no --control\n",
    ACTOR + '[groups]\narms = ["actor.comand"] #! group arms: no input "actor.comand", did you mean'
    ' "actor.command"?\n',
    ACTOR + '[groups]\narms = 3 #! a group is a list of inputs, as "MODULE.PORT", and addresses\n',
    ACTOR + '[groups]\nall = [] #! a group\'s name is snake_case and not "all", not "all"\n',
    ACTOR
    + '[[links]]\nfrom = "actor.pose"\nto = "tcp:7000"\nroute = "some" #! "route" is a list of'
    ' addresses, or "all"\n',
    '[modules.relay]\nprogram = "./relay"\n[[links]]\nfrom = "relay.out"\nto = "tcp:7000"\n'
    'route = [3] #! module relay cannot have "route": its program knows no --control\n',
    # Modes, the workspace, exclusive inputs and actors.
    ACTOR + 'mode = "trak" #! no mode "trak", did you mean "track"?\n' + TRACK,
    ACTOR + 'modes = ["track", "trak"] #! no mode "trak", did you mean "track"?\n' + TRACK,
    ACTOR + 'modes = 3 #! "modes" is a list of strings\n',
    ACTOR + "[modes]\ntrack = 0 #! a mode is a whole number from 1 to 2147483647\n",
    ACTOR + "[modes]\ntrack = 1 #! nobody can begin or leave mode track: no module has mode ="
    ' "track"\n',
    TRACK + "read = 1 #! the modes track and read have the same number\n" + READER,
    ACTOR + 'idle_rate = -1 #! "idle_rate" is a number from 0 to 1000000 [Hz]\n',
    ACTOR + 'ends_graph = 1 #! "ends_graph" is true or false\n',
    ACTOR
    + 'exclusive = ["command"] #! an exclusive input wants a [workspace], which says what is in'
    " focus\n",
    ACTOR
    + 'exclusive = ["comand"] #! module actor has no input "comand", did you mean "command"?\n'
    + WORKSPACE,
    '[modules.relay]\nprogram = "./relay"\nidle_rate = 2 #! module relay cannot have "idle_rate": its'
    " program knows no --control\n",
    ACTOR + '[workspace] #! "module" is missing\n',
    ACTOR + 'exclusive = ["command"]\n[workspace] #! "module" is missing\n',
    ACTOR
    + '[workspace]\nmodul = "actor" #! no key "modul" in the workspace, did you mean "module"?\n',
    '[modules.relay]\nprogram = "./relay"\nmode = "x" #! module relay cannot have "mode": its program'
    " knows no --control\n",
    ACTOR
    + 'to.pose = "" #! "to" is an address from -2147483647 to 2147483647 without 0, or a name\n',
    ACTOR + '[workspace]\nmodule = "acto" #! no module "acto", did you mean "actor"?\n',
    ACTOR + '[workspace]\nmodule = "actor" #! module actor has no output "focus"\n',
    ACTOR + '[workspace]\nmodul = 3 #! no key "modul" in the workspace, did you mean "module"?'
    '\nmodule = "actor" #! module actor has no output "focus"\n',
    RELAYS
    + ACTOR
    + '[[links]]\nfrom = "a.out"\nto = "actor.command"\n'
    + "[[links]] #! actor.command is an actor's and gets commands from a.out and b.out; make it"
    ' exclusive, or put a router before it\nfrom = "b.out"\nto = "actor.command"\n',
    # The world outside.
    LINKED.replace("[[links]]", "[[links]] #! a link has a module at one of its ends")
    .replace("camera.left", "tcp:1")
    .replace("brightness.image", "tcp:2"),
    LINKED.replace(
        "[[links]]",
        '[[links]] #! module brightness has no links of the kind "tpc", did you mean "tcp"?',
    ).replace("camera.left", "tpc:1"),
    LINKED.replace(
        "[[links]]", '[[links]] #! module brightness has no links of the kind "inproc"'
    ).replace("camera.left", "inproc:x"),
    LINKED.replace("camera.left", "tcp:1")
    + "rate = 3 #! a link from outside has no rate: that is its"
    " sender's\n",
    LINKED
    + '[[links]]\nfrom = "camera.left"\nto = "tcp:1?rate=2"\nrate = 3 #! tcp:1?rate=2 has rate too\n',
    *(
        '[modules.camera]\n[[links]] #! %s: %s\nfrom = "camera.left"\nto = "%s"\n'
        % (uri, what, uri)
        for uri, what in (
            ("tcp-listen:abc", "a port is a number"),
            ("tcp:", "a port is a number"),
            ("tcp:99999", "a port is a number"),
            ("unix:@", "there is no name"),
            ("file:", "there is no name"),
            ("tcp:1?wait=x", "option wait"),
            ("tcp:1?wiat=3", 'tcp has no option "wiat" here'),
            ("tcp:1?keep=some", "option keep"),
        )
    ),
    LINKED.replace("camera.left", "tcp-listen:1")
    + "[[links]] #! tcp-listen:1 is there twice, and two cannot listen there\n"
    'from = "camera.left"\nto = "tcp-listen:1"\n',
    # Frames.
    ACTOR + '[frames.a] #! "parent" is missing\n',
    FRAME + 'speed = 3 #! no key "speed" in frame head\n',
    FRAME + 'translation = [1, 2] #! "translation" is a list of 3 numbers\n',
    FRAME + 'rotation = [1, 2, "x"] #! "rotation" is a list of 3 numbers\n',
    FRAME + 'quaternion = [1, 1, 0, 0] #! "quaternion" has the length 1\n',
    FRAME
    + 'rotation = [0, 0, 0]\nquaternion = [1, 0, 0, 0] #! a frame has "rotation" or "quaternion",'
    " not both\n",
    FRAME + 'moved_by = "actor.pos" #! module actor has no output "pos", did you mean "pose"?\n',
    FRAME + 'moved_by = "acto.pose" #! no module "acto", did you mean "actor"?\n',
    FRAME + 'moved_by = "actor.pose"\ntranslation = [1, 2, 3] #! a frame that is moved has no'
    ' "translation"\n',
    FRAME + '[frames.a]\nparent = "head"\nmoved_by = "actor.pose"\n[frames.b]\nparent = "head"\n'
    'moved_by = "actor.pose" #! actor.pose moves a and b, so they and their parents need a "coord"\n',
    FRAME
    + '[frames.eye]\nparent = "haed" #! no frame "haed", did you mean "head"?; the root is robot\n',
    ACTOR
    + '[frames.a]\nparent = "b" #! frames form a circle: a in b in a\n[frames.b]\nparent = "a"\n',
    FRAME + 'coord = 1000 #! "coord" is a whole number from 1 to 999\n',
    FRAME + "coord = 4 #! frame head has the number 3\n",
    FRAME + '[frames.nose]\nparent = "head"\ncoord = 3 #! coordinate system 3 is head\n',
    # Graphs within graphs.
    '[graphs.a]\nfile = "none.toml" #! none.toml: cannot be read\n',
    '[graphs.a] #! "file" is missing\n',
    '[graphs.a]\nfile = "g.toml" #! g.toml includes itself\n',
    '[graphs.a]\nfile = "part.toml"\nparameters.relai.x = 3 #! graph a has no module "relai", did you'
    ' mean "relay"?\n',
    '[graphs.a]\nfile = "part.toml"\nparameters.relay.x = 3 #! module a_relay has no parameter "x"\n',
    '[graphs.a]\nfil = "part.toml" #! no key "fil" in graph a, did you mean "file"?\n'
    'file = "part.toml"\n',
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
    LINKED + 'rate = "" #! option rate has no value\n',
    LINKED + "rate = -1 #! option rate is a whole number from 1 to 4294967296\nburst = 3\n",
    LINKED + "rate = 1.5 #! rate is a whole number or a string\nburst = 3\n",
    LINKED
    + 'memory = "1X" #! option memory is a whole number from 1 to 4294967296, also as K, M or G\n',
    LINKED.replace("from =", "form =").replace(
        'left"', 'left" #! no key "form" in a link, did you mean "from"?'
    ),
    LINKED.replace("camera.left", "camra.left").replace(
        "[[links]]", '[[links]] #! no module "camra", did you mean "camera"?'
    )
    + LINK.replace("camera.left", "camra.left").replace(
        "[[links]]", "[[links]] #! the link from camra.left to brightness.image is there twice"
    ),
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
FOCUS = TYPE.replace("f64", "i32")


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
    "actor": program(port("command", more=',"actor":true'), port("pose"), CONTROL),
    "workspace": program(port("bids"), port("focus", FOCUS), CONTROL),
}
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
    def write_programs(self):
        for name, text in PROGRAMS.items():
            self.write(name, text, 0o755)

    def refuse(self, verb, text):
        self.write("g.toml", text)
        out = self.shell("hc %s g.toml" % verb, 2)
        self.assertEqual(out, "")
        lines = self.err.splitlines()
        for said, wanted in zip(lines, wanted_lines(text)):
            self.assertEqual(
                said[: len("hc %s: Invalid: %s" % (verb, wanted))],
                "hc %s: Invalid: %s" % (verb, wanted),
                text,
            )
        self.assertEqual(len(lines), len(wanted_lines(text)), (text, self.err))
        return lines

    def test_every_broken_graph_is_refused_line_by_line_and_not_run(self):
        self.write_programs()
        self.write("liar", LIAR, 0o755)
        self.write("plain", "")
        self.write("part.toml", '[modules.relay]\nprogram = "./relay"\n')
        self.assertGreaterEqual(len(set(BROKEN)), 100)
        for text in BROKEN:
            said = self.refuse("check", text)
            run = self.refuse("run", text)
            self.assertEqual([line[len("hc check") :] for line in said], [x[6:] for x in run])

    def test_right_graphs_are_counted(self):
        self.environment["HC_DATA"] = DATA
        included = {
            "real_head.toml",
            "simulated_head.toml",
        }  # wants the workspace of who includes it
        for graph in sorted(set(os.listdir(ROOT / "graphs")) - included):
            out = self.shell("hc check %s/graphs/%s" % (ROOT, graph))
            self.assertRegex(out, r"\.toml: [0-9]+ modules?, [0-9]+ links?: nothing is wrong\n$")

    def test_a_real_head_has_the_tasks_of_the_simulated_one(self):
        def tasks(name):
            text = (ROOT / "graphs" / name).read_text()
            own = r"^(#.*|parameters.calibration_file = .*|parameters.eyes = .*)\n"
            text = re.sub(own, "", text, flags=re.M)
            text = re.sub(r'calibration_file = "[^"]*", ', "", text)
            return text.replace("real_head.toml", "simulated_head.toml")

        self.assertEqual(tasks("head.toml").strip(), tasks("head_real.toml").strip())

    def test_errors_of_an_included_file_name_it_and_programs_are_sought_beside_it(self):
        os.mkdir(self.path("parts"))
        self.write("parts/relay", PROGRAMS["relay"], 0o755)
        self.write("parts/ring.toml", RELAYS + '[[links]]\nfrom = "a.out"\nto = "b.in"\n')
        self.write("g.toml", '[graphs.x]\nfile = "parts/ring.toml"\n')
        self.assertIn("2 modules, 1 link: nothing", self.shell("hc check g.toml"))
        self.write("parts/ring.toml", RELAYS + '[[links]]\nfrom = "a.out"\nto = "c.in"\n')
        self.shell("hc check g.toml", 2)
        self.assertEqual(
            self.err, 'hc check: Invalid: parts/ring.toml:5: no module "x_c", did you mean "x_a"?\n'
        )

    def test_what_is_no_text_file_is_told_in_one_line(self):
        for verb in "check", "run":
            self.shell("hc %s ." % verb, 1)
            self.assertEqual(self.err, "hc %s: NotFound: .: is a folder, not a file\n" % verb)
            self.write("latin.toml", b"[modules.camera]\n# \xe4\n")
            self.shell("hc %s latin.toml" % verb, 2)
            self.assertEqual(
                self.err,
                "hc %s: Invalid: latin.toml:2: a graph file is UTF-8, which this line is not\n"
                % verb,
            )
            self.write("part.toml", "[modules\n")
            self.shell("hc %s part.toml --set camera.width=3" % verb, 2)
            self.assertEqual(len(self.err.splitlines()), 1, self.err)

    def test_settings_are_checked_too(self):
        self.write("g.toml", LINKED)
        self.shell("hc check g.toml --set camera.width=-1 --set camra.width=2", 2)
        self.assertEqual(
            self.err.splitlines(),
            [
                'hc check: Invalid: --set: no module "camra" in g.toml, did you mean "camera"?',
                'hc check: Invalid: --set: module camera: parameter width: "-1" is not from 0 to 65535',
            ],
        )


if __name__ == "__main__":
    unittest.main()
