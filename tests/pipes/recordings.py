# SPDX-License-Identifier: Apache-2.0
"""A recorded task of the head: its graph, its messages, and how a module of it is fed from them."""

import bisect
import functools
import pathlib
import shlex
import tomllib
from collections import namedtuple

from harness import ROOT

COMPONENT_BYTES = {0: 1, 2: 2, 3: 2, 8: 4, 9: 8}  # of u8, i16, u16, f32, f64

# `fixed` are dst, info, mode, coord, width and height; src and seq are not kept.
Message = namedtuple("Message", "time fixed elements")


class Late(AssertionError):
    """What was recorded differs by more than a replay on a machine that has time for the robot."""


def record_again(test):
    """Repeats a test, four times at most, where a module was late; what is broken fails each
    time."""

    @functools.wraps(test)
    def tried(self):
        for _ in range(4):
            try:
                return test(self)
            except Late as late:
                print("late: %s" % late, flush=True)
                self.doCleanups()
                self.setUp()
        return test(self)

    return tried


def read_messages(path):
    """The messages of a recording, in its order."""
    data = pathlib.Path(path).read_bytes()
    found, at = [], 0
    while at < len(data):
        end = data.index(b"\n", at)
        header = [int(word) for word in data[at:end].split()]
        info, width, height = header[6], header[9], header[10]
        # The size of the elements is known where they are binary, else they are text.
        if info % 10 == 1:
            stop = end + 1 + width * height * (info // 100 % 100) * COMPONENT_BYTES[info // 10 % 10]
        else:
            stop = end
            for _ in range(height):
                stop = data.index(b"\n", stop + 1)
        fixed = (header[2], info) + tuple(header[7:])
        found.append(Message(header[5], fixed, data[end:stop]))
        at = stop + 1
    return found


def numbers(message):
    return [float(word) for word in message.elements.split()]


def share_within(some, others, seconds, difference):
    """Of messages of numbers, the share with which one of others agrees that is so near in time;
    where there are others, for half of them at least."""
    times = [message.time for message in others]
    values = [numbers(message) for message in others]
    reach, agreed, all_some = round(seconds * 1e9), 0, len(some)
    some = [each for each in some if times and times[0] <= each.time <= times[-1]]
    if len(some) < all_some / 2:
        return 0
    for message in some:
        own = numbers(message)
        near = range(
            bisect.bisect_left(times, message.time - reach),
            bisect.bisect_right(times, message.time + reach),
        )
        agreed += any(
            len(own) == len(values[i])
            and all(abs(a - b) <= difference for a, b in zip(own, values[i]))
            for i in near
        )
    return agreed / len(some)


def writers(end):
    """The outputs that an input reads."""
    if isinstance(end, dict):
        end = end["from"]
    return [end] if isinstance(end, str) else [each for one in end for each in writers(one)]


class Task:
    """The graph score_TASK.toml with parameters MODULE.NAME=VALUE, as far as it says how modules are
    started."""

    def __init__(self, task, settings):
        self.file = ROOT / ("graphs/score_%s.toml" % task)
        self.settings = settings
        graph = tomllib.loads(self.file.read_text())
        included = graph["graphs"]["head"]
        head = tomllib.loads((self.file.parent / included["file"]).read_text())
        self.modes = graph["modes"]
        self.modules = dict(graph["modules"])
        for name, module in head["modules"].items():
            for port, end in module.get("inputs", {}).items():
                module["inputs"][port] = ["head_" + each for each in writers(end)]
            for key, given in included.get("modules", {}).get(name, {}).items():
                module.setdefault(key, {}).update(given)
            module.setdefault("program", name)
            self.modules["head_" + name] = module
        self.links = [
            (writer, "%s.%s" % (name, port))
            for name, module in self.modules.items()
            for port, end in module.get("inputs", {}).items()
            for writer in writers(end)
        ]
        for setting in settings:
            target, value = setting.split("=")
            name, parameter = target.split(".")
            self.modules[name].setdefault("parameters", {})[parameter] = value

        # What `hc run` links: the poses of the head, to all that ask for frames.
        for name, module in self.modules.items():
            program = module.get("program", name)
            if program in ("gaze", "calibrate"):
                self.links.append(("head_neck.pose", name + ".frames"))

    def record_command(self):
        options = "".join(" --set %s" % setting for setting in self.settings)
        return "hc run %s --record kept%s" % (self.file, options)

    def recorded(self):
        return sorted({begin for begin, _ in self.links} | {"workspace.focus"})

    def has_inputs(self, name):
        return any(end.split(".")[0] == name for _, end in self.links)

    def replay_command(self, name, inputs=(), **parameters):
        """The module alone, as the graph starts it: its recorded inputs come from kept/, or as
        `inputs` says, what it sends goes to again/. Parameters that are given here stand above those
        of the graph."""
        module = self.modules[name]
        words = ["hc", module.get("program", name), "--clock", "messages"]
        for parameter, value in dict(module.get("parameters", {}), **parameters).items():
            text = str(value).lower() if isinstance(value, bool) else str(value)
            words.append("--%s=%s" % (parameter, text))
        for port in module.get("exclusive", []):
            words += ["--exclusive", port, "--in", "focus=kept/workspace.focus.mtp"]
        if "mode" in module:
            words += ["--mode", str(self.modes[module["mode"]])]
        links = [(begin, end) for begin, end in self.links if end.split(".")[0] == name]
        for link in inputs or [
            "%s=kept/%s.mtp" % (end.split(".")[1], begin) for begin, end in links
        ]:
            words += ["--in", link]
        for output in self.recorded():
            if output.split(".")[0] == name:
                words += ["--out", "%s=again/%s.mtp" % (output.split(".")[1], output)]
        return shlex.join(words)
