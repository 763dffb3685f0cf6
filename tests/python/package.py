# SPDX-License-Identifier: Apache-2.0
"""What the tests of the Python package share: the package itself, modules in files, publishers.

    messages_test.py BUILD_FOLDER [TEST …], and so the others
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "pipes"))

from harness import BUILD, Pipes, ROOT, WATCHDOG, wait_until  # noqa: E402

sys.path.insert(0, str(BUILD / "python"))

import hypercolumn as hc  # noqa: E402

__all__ = [
    "BUILD",
    "ECHO",
    "IN",
    "Modules",
    "Package",
    "ROOT",
    "WATCHDOG",
    "hc",
    "mappings",
    "wait_until",
]

PUBLISHER = """
import hypercolumn as hc
module = hc.Module("publisher", "Sends images, each of one number: how many there were before.")
image = module.output("image", hc.rgb_image(), "an image")
count = module.parameter("count", 0, "", "images; 0: without end")
height = module.parameter("height", 600, "px", "of them")
sent = 0

@module.generate
def publish():
    global sent
    with image.loan(height.value, 800, time=sent + 1) as pixels:
        pixels[:] = sent % 256
    sent += 1
    if sent == count.value:
        module.stop()

module.run()
"""


def mappings(pid="self"):
    """Address ranges of shared memory that a process sees: [(int, int)]."""
    found = []
    for line in pathlib.Path("/proc/%s/maps" % pid).read_text().splitlines():
        words = line.split()
        if "s" in words[1] and "/memfd:" in line:
            found.append(tuple(int(each, 16) for each in words[0].split("-")))
    return found


def is_shared(array):
    """Whether an array's elements are in shared memory."""
    address = array.__array_interface__["data"][0]
    return any(begin <= address < end for begin, end in mappings())


class Package(Pipes):
    def setUp(self):
        super().setUp()
        self.environment["PYTHONPATH"] = str(BUILD / "python")

    def write_module(self, name, text):
        """A module in the test's folder; gives its path."""
        path = pathlib.Path(self.path(name))
        path.write_text("#!/usr/bin/env python3\n" + text)
        path.chmod(0o755)
        return str(path)

    def link(self, name="link"):
        """A URI of shared memory of this test alone."""
        return "shm:%s-%s" % (pathlib.Path(self.folder.name).name, name)

    def publish(self, *options, uri_options="readers=1"):
        """Starts a publisher; gives its process and the stream of what it sends."""
        program = self.write_module("publisher", PUBLISHER)
        uri = self.link()
        process = self.start(
            "exec %s --out 'image=%s?%s' %s" % (program, uri, uri_options, " ".join(options))
        )
        stream = hc.open(uri + "?wait=60")
        self.addCleanup(stream.close)
        return process, stream


ECHO = """
import hypercolumn as hc
module = hc.Module("echo", "Sends what comes.")
numbers = module.input("numbers", hc.table(), "any numbers")
out = module.output("out", hc.%s, "what it is made into")

@module.on(numbers)
def echo(message):
    %s

module.run()
"""
IN = b"1 7 0 0 8 55 120190 3 0 3 1\n1 2.5 -3\n"


class Modules(Package):
    def run_module(self, text, arguments="", data=b"", status=0):
        program = self.write_module("module", text)
        out = self.shell(program + " " + arguments, status, data)
        return out

    def echo(self, kind, body, arguments="", data=IN, status=0):
        return self.run_module(ECHO % (kind, body), arguments, data, status)
