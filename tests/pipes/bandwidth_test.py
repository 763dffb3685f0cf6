#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Links with a bandwidth, and links that slow down while nothing changes."""

import unittest

from graphs import Graphs
from harness import DATA

EYES = """
[modules.camera]
parameters = { source = "%s/aloeL.jpg", right_source = "%s/aloeR.jpg", loop = true, rate = 20, width = 640, height = 480 }
""" % (
    DATA,
    DATA,
)
PAIR = """
[modules.rectify]
inputs.left = { from = "camera.left", %s }
inputs.right = { from = "camera.right", %s }
"""


class Bandwidth(Graphs):
    def images(self, process, condition):
        """The state, once quality and scale are alike on both links, and as wanted."""
        messages = self.observed(process)

        def are_wanted(state):
            left, right = [link["images"] for link in state["links"]]
            return left is not None and left == right and condition(left)

        return self.state(messages, are_wanted)

    def test_both_eyes_follow_their_links_alike(self):
        policy = 'bandwidth = "150 kB/s"'  # too little for two images a second of a busy computer
        process = self.running_graph(EYES + PAIR % (policy, policy), last="rectify: started")
        state = self.images(process, lambda form: form[0] < 90)
        self.assertEqual([link["bandwidth"] for link in state["links"]], [150_000, 150_000])
        self.assertRegex(
            self.hc("top --once --of g.%d" % process.pid),
            r"camera.left → rectify.left .* at most 150kB/s: quality \d+, scale [\d.]+",
        )
        # It may be changed while it runs: the scale follows, and comes back.
        change = "graph --of g.%d link camera.left rectify.left bandwidth=%s"
        for bandwidth, is_so in (("60kB/s", lambda x: x < 1), ("4MB/s", lambda x: x == 1)):
            for eye in ("left", "right"):
                self.hc(change.replace("left", eye) % (process.pid, bandwidth))
            self.images(process, lambda form, is_so=is_so: is_so(form[1]))

    def test_a_link_slows_down_while_nothing_changes(self):
        policy = "idle_rate = 1"
        process = self.running_graph(EYES + PAIR % (policy, policy), last="rectify: started")
        messages = self.observed(process)
        state = self.state(
            messages, lambda state: all(link["throttled"] > 40 for link in state["links"])
        )
        for link in state["links"]:
            self.assertLess(link["messages"] - link["throttled"], 22 + link["throttled"] / 10)


if __name__ == "__main__":
    unittest.main()
