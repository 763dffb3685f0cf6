#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What goes over links between hosts, and over bad networks. Needs root.

    links_test.py BUILD_FOLDER [TEST …]
"""

import unittest

from hosts import DATA, HostsTest

CAMERA = """
[modules.camera]
host = "%s"
parameters = {{ source = "{0}/aloeL.jpg", loop = true, rate = 50, width = 320, height = 240 }}
"""
SMALL = """
[modules.small]
program = "relay"
inputs.in = { from = "camera.left", as = "jpeg", quality = 70, scale = 0.5, rate = 20 }
outputs.out = { to = "file:%s", keep = "all" }
[modules.whole]
program = "brightness"
inputs.image = "camera.left"
"""
WHOLE_BYTES = 320 * 240 * 3


class Links(HostsTest):
    def test_images_made_small_by_their_sender(self):
        """Little goes over the network; the reader gets ordinary images of half the size."""
        (host,) = self.network.add()
        for where, transport in (("h1", "tls"), ("", "shm")):
            self.write_graph(
                self.tables(host)
                + CAMERA.format(DATA) % where
                + SMALL % self.path("small")
            )
            self.assertIn("no problems found", self.shell("hc check g.toml"))
            process = self.run_graph("", "whole: started")
            messages = self.observe(process)
            small, whole = ("camera.left", "small.in"), ("camera.left", "whole.image")
            # What the rate drops is counted, whoever keeps it.
            state = self.state(
                messages,
                lambda state: self.rate(state, *small)
                and self.rate(state, *whole)
                and self.link(state, *small)["messages"] > 50
                and self.link(state, *small)["throttled"] > 10,
            )
            link = self.link(state, *small)
            self.assertEqual(link["transport"], transport)
            sent = link["messages"] - (link["throttled"] if transport == "tls" else 0)
            self.assertLess(link["bytes"] / sent, WHOLE_BYTES / 20, link)
            link = self.link(state, *whole)
            self.assertGreater(link["bytes"] / link["messages"], WHOLE_BYTES, link)
            # Another scale while it runs.
            self.assertEqual(
                self.ask(process, "link camera.left small.in scale=0.25 keep=latest"), ["ok"]
            )
            self.state(messages, lambda state: (self.link(state, *small) or link)["rate"] == 0)
            self.flows_on(messages, *small)
            self.stop(process)
            self.assert_empty(host)
            sizes = self.shell("hc cat small | cut -d, -f 1 | sort | uniq -c")
            self.assertRegex(sizes, "rgb_image 160 x 120 of 3 x u8")
            self.assertRegex(sizes, "rgb_image 80 x 60 of 3 x u8")
            self.assertRegex(self.shell("hc cat small --count 1 --json"), '"coord": ?7')

    def flows_on(self, messages, *link):
        first = self.link(self.state(messages, lambda state: self.link(state, *link)), *link)
        self.state(
            messages, lambda state: self.link(state, *link)["messages"] > first["messages"] + 10
        )


if __name__ == "__main__":
    unittest.main()
