#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What goes over links between hosts, and over bad networks. Needs root.

    links_test.py BUILD_FOLDER [TEST …]

HC_FULL=1 follows for longer, cuts ten times, and holds all to the times that doc/hosts.md promises.
"""

import math
import re
import statistics
import time
import unittest

from hosts import BUILD, DATA, FULL, HostsTest, ROOT, report, wait_until

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
# The robot has eyes and a neck; what it sees is followed from here.
ROBOT = """
[graphs.head]
file = "{0}/graphs/simulated_head.toml"
host = "h1"
modules.eyes.parameters = {{ ball = "roll", ball_hidden = 2 }}
modules.neck.inputs.command = {{ from = "track.command", keep = "latest", rate = 200 }}
modules.neck.outputs.pose = {{ to = "file:{1}?append=1", keep = "all" }}
"""
FOLLOWS = """
[modes]
track = 1
[workspace]
module = "workspace"
[modules.workspace]
inputs.bids = "track.bid"
[modules.left_ball]
program = "blob"
inputs.image = { from = "head_eyes.left", as = "jpeg", quality = 75, scale = 0.5 }
[modules.right_ball]
program = "blob"
inputs.image = { from = "head_eyes.right", as = "jpeg", quality = 75, scale = 0.5 }
[modules.track]
program = "gaze"
mode = "track"
parameters = { focal = 300, cx = 199.5, cy = 149.5 }
inputs.target = ["left_ball.target", "right_ball.target"]
"""
SCORE = """
[modules.track_score]
parameters.duration = %d
ends_graph = true
inputs = { left_pose = "head_eyes.left_pose", ball = "head_eyes.ball", ball_seen = "head_eyes.ball_seen" }
"""
CABLE = str(BUILD / "tests/cable")
WHOLE_BYTES = 320 * 240 * 3


class Links(HostsTest):
    def test_images_made_small_by_their_sender(self):
        """Little goes over the network; the reader gets ordinary images of half the size."""
        (host,) = self.network.add()
        for where, transport in (("h1", "tls"), ("", "shm")):
            self.write_graph(
                self.tables(host) + CAMERA.format(DATA) % where + SMALL % self.path("small")
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

    def follow(self, host, duration):
        """RMS error of the head that follows a ball [degree]."""
        text = ROBOT.format(ROOT, self.path("poses")) + FOLLOWS + SCORE % duration
        self.write_graph(
            (self.tables(host) if host else "")
            + (text if host else text.replace('host = "h1"', ""))
        )
        out = self.shell("hc run --quiet --links g.toml")
        return float(re.search(r"track_score: .*RMS error ([\d.]+)°", out)[1])

    def test_what_a_slow_network_drops_is_counted(self):
        """Whole images are too much for it: the newest go, and the rest is dropped by the sender."""
        (host,) = self.network.add(cable=CABLE)
        host.worsen(5, 0, 2_000_000)
        kept = SMALL.replace('as = "jpeg", quality = 70, scale = 0.5, rate = 20', "rate = 30")
        process = self.running_graph(
            self.tables(host) + CAMERA.format(DATA) % "h1" + kept % self.path("whole"),
            "",
            "whole: started",
        )
        messages = self.observe(process)
        link = ("camera.left", "small.in")
        state = self.state(
            messages,
            lambda state: self.rate(state, *link) and self.link(state, *link)["dropped_newer"] > 50
            # More is shown when `hc run` was held up, and takes two reports at once.
            and self.link(state, *link)["bytes_per_second"] < 2.5e6,
        )
        self.assertTrue(state["hosts"][0]["connected"])
        # Once it is fast again all that comes gets through.
        host.worsen()
        state = self.state(messages, lambda state: self.link(state, *link)["per_second"] > 10)
        self.stop(process)
        count = len(re.findall("rgb_image", self.shell("hc cat whole")))
        link = self.link(state, *link)
        self.assertGreater(count, 10)
        self.assertLess(count, link["messages"] + 200 - link["dropped_newer"])
        self.assert_empty(host)

    def test_the_loop_closes_over_a_bad_network(self):
        """Eye, blob, gaze and neck, with 20 ms each way, and one of a hundred packets lost."""
        (host,) = self.network.add(cable=CABLE)
        duration = 20 if FULL else 6
        near = self.follow(None, duration)
        host.worsen(20, 0.01)
        far = self.follow(host, duration)
        self.assertLess(far, near + (2 if FULL else 12))  # some 30° if it did not follow
        report("follows a ball: RMS error %.2f° on one host, %.2f° over the network", near, far)
        self.assert_empty(host)

    def test_the_neck_stops_when_the_cable_is_cut(self):
        (host,) = self.network.add(cable=CABLE)
        host.worsen(20, 0.01)
        text = ROBOT.format(ROOT, self.path("poses")) + FOLLOWS
        process = self.running_graph(self.tables(host) + text, "", "head_neck: started")
        messages = self.observe(process)
        stopped = []

        def stops():
            wait_until(self.turns)
            host.worsen(loss=1)
            cut = time.time()
            # Longer than the neck keeps moving, and shorter than what ends the connection.
            wait_until(lambda: self.poses()[-1][0] > cut + 0.9)
            host.worsen(20, 0.01)
            stopped.append(self.stop_of(cut))
            wait_until(lambda: self.turned_since(cut + 1))

        for _ in range(10 if FULL else 1):
            stops()
        self.assertLess(max(stopped), 0.2 if FULL else 0.5)
        report("the neck stops %.0f ms after a cut, %.0f ms at most of %d", *self.figures(stopped))
        # The connection is lost, and what ran there has ended; all of it comes back.
        host.worsen(loss=1)
        self.state(messages, lambda state: not state["hosts"][0]["connected"])
        self.assert_empty(host)
        host.worsen(20, 0.01)
        self.state(
            messages,
            lambda state: state["hosts"][0]["connected"]
            and self.all_run(state)
            and self.rate(state, "head_eyes.left", "left_ball.image"),
        )
        back = time.time()
        wait_until(lambda: self.turned_since(back))
        self.stop(process)
        self.assert_empty(host)

    @staticmethod
    def figures(times):
        return 1e3 * statistics.median(times), 1e3 * max(times), len(times)

    def poses(self):
        """Of the head so far: times [s] and pan [degree]."""
        pan = lambda rows: math.degrees(math.atan2(rows[1][0], rows[0][0]))
        return [(each.time / 1e9, pan(each.rows)) for each in self.recorded("poses")]

    def turns(self):
        """Whether the head turns now."""
        poses = self.poses()[-10:]
        return len(poses) == 10 and abs(poses[-1][1] - poses[0][1]) > 1

    def turned_since(self, when):
        pans = [pan for t, pan in self.poses() if t > when]
        return len(pans) > 1 and max(pans) - min(pans) > 2

    def stop_of(self, cut):
        """When the head stopped, after a cut [s]."""
        poses = [(t, pan) for t, pan in self.poses() if cut - 1 < t < cut + 0.9]
        if len(poses) < 10:
            return math.inf  # nothing is known of it
        final = poses[-1][1]
        return max((t for t, pan in poses if abs(pan - final) > 0.1), default=math.inf) - cut

    def flows_on(self, messages, *link):
        first = self.link(self.state(messages, lambda state: self.link(state, *link)), *link)
        self.state(
            messages, lambda state: self.link(state, *link)["messages"] > first["messages"] + 10
        )


if __name__ == "__main__":
    unittest.main()
