# SPDX-License-Identifier: Apache-2.0
"""A graph to be recorded, and what tests of recordings share."""

import os
import re
import shlex
import subprocess

from graphs import Graphs
from harness import WATCHDOG
from namespaces import UNSHARE

CAMERA = "hc camera $HC_DATA/aloeL.jpg --width 80 --height 60 --loop --rate 50"
GRAPH = """version = 1
[modules.camera]
parameters = { source = "%s/aloeL.jpg", width = 80, height = 60, loop = true, rate = 50, count = %d }
ends_graph = true
[modules.brightness]
inputs.image = { from = "camera.left", keep = "all" }
outputs.mean = "file:mean.mtp"
[modules.view]
parameters = { save = "last.png", window = "no" }
inputs.image = "camera.left"
"""


class Recordings(Graphs):
    def noise(self, count, name="noise.mtp"):
        """A file of so many grey images of 16 kB, which do not get smaller."""
        head = "1 7 0 %d 8 %d 40101 0 7 128 128\n"
        with open(self.path(name), "wb") as file:
            for i in range(count):
                file.write(
                    (head % (i, 10**18 + i * 1000)).encode() + os.urandom(128 * 128) + b"\n"
                )

    def seqs(self, name):
        """The seq of each message of a recording."""
        out = self.shell("hc cat --json '%s'" % name)
        return [int(seq) for seq in re.findall(r'"seq":(\d+)', out)]

    def on_a_small_disk(self, command):
        """The status of a command in a shell for which the folder `disk` is a disk of 2 MB; what is on
        it then is in the folder `kept`."""
        own = [*UNSHARE, "--mount", "sh", "-c"]
        mount = "mount -t tmpfs -o size=2m none disk"
        os.makedirs(self.path("disk"), exist_ok=True)
        if subprocess.run(own + [mount], cwd=self.folder.name, stderr=-1, check=False).returncode:
            self.skipTest("no mount namespaces, in which a small disk would be made")
        text = "%s && { %s; status=$?; cp -r disk kept; exit $status; }" % (mount, command)
        process = self.start("exec " + shlex.join(own + [text]))
        out, err = process.communicate(timeout=WATCHDOG)
        self.out, self.err = out.decode(), err.decode()
        return process.returncode

    def recorders(self):
        """The recorders that run in this folder."""
        here = os.path.realpath(self.folder.name)
        found = []
        for pid in subprocess.run(["pgrep", "-x", "recorder"], stdout=-1).stdout.split():
            try:
                if os.readlink("/proc/%d/cwd" % int(pid)) == here:
                    found.append(int(pid))
            except OSError:
                pass
        return found

    def sent(self, runner, graph):
        """How many images the camera has sent."""
        links = self.state_of(runner, graph)["links"]
        return next(each["messages"] for each in links if each["to"] == "brightness.image")
