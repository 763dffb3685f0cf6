# SPDX-License-Identifier: Apache-2.0
"""Shared by the tests of modules that see the simulated room."""

import json

from harness import Pipes


class Sight(Pipes):
    """The head looks straight ahead; its left eye is at (0.06, 0.05, 1.25) m of the world."""

    SIMULATOR = "hc simulator --count 3 --paced=false --start 1000000000 %s </dev/null"
    SIDES = (
        "apriltag:0=0.3 apriltag:7=0.16 aruco:23=0.18 aruco:40=0.14 "
        "colour:300=0.14 colour:180=0.12 colour:120=0.12"
    )

    def simulate(self, options, **outputs):
        links = "".join(" --out %s=%s" % link for link in outputs.items())
        self.shell(self.SIMULATOR % (options + links))

    def messages(self, command):
        """The rows of each message."""
        lines = self.shell(command + " | hc cat --json").splitlines()
        return [row for line in lines for row in json.loads(line)["elements"]]

    @staticmethod
    def in_left_eye(place):
        return [0.05 - place[1], 1.25 - place[2], place[0] - 0.06]
