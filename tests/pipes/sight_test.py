#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the eyes' modules see of the simulated room, compared with how it is."""

import json
import math
import re
import unittest

from sight import Sight


def turn(q, v):
    """A vector, turned by a quaternion x y z w."""
    x, y, z, w = q
    t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])]
    return [
        v[0] + w * t[0] + y * t[2] - z * t[1],
        v[1] + w * t[1] + z * t[0] - x * t[2],
        v[2] + w * t[2] + x * t[1] - y * t[0],
    ]


class Seen(Sight):
    FRAMES = (
        "--frames 'left_eye 4 head 0 0 0 0 0 0 1; right_eye 5 left_eye 0.1 0 0 0 0 0 1; "
        "head 3 world 0 0 0 0 0 0 1'"
    )

    def test_markers_are_where_the_room_has_them(self):
        self.simulate("--seed 1 --noise 2", left="left.mtp", markers="markers.mtp")
        markers = {tuple(row[:2]): row for row in self.messages("cat markers.mtp")}
        found = self.messages(
            "hc marker --focal 600 --sides '%s' --in image=left.mtp --out markers=-" % self.SIDES
        )
        self.assertGreaterEqual(len({tuple(row[:2]) for row in found}), 5)
        for row in found:
            marker = markers[tuple(row[:2])]
            truth = self.in_left_eye(marker[3:6])
            self.assertLess(math.dist(row[3:6], truth), 0.01 * math.hypot(*truth), row)
            # The marker's x axis, in both; the room's axes are those of the eye in another order.
            x = turn(marker[6:10], [1, 0, 0])
            cosine = sum(a * b for a, b in zip(turn(row[6:10], [1, 0, 0]), [-x[1], -x[2], x[0]]))
            self.assertGreater(cosine, math.cos(math.radians(4)), row)
            self.assertLess(row[10], 0.3, "reprojected, px")

    def test_a_marker_that_has_a_frame_is_a_pose_of_it(self):
        self.simulate("--seed 2", left="left.mtp", right="right.mtp")
        names = (
            "--marker_frames 'aruco:23=101 colour:300=103' --focal 600 --side 0.18 --out poses=-"
        )
        for eye, number in (("left", 4000), ("right", 5000)):
            out = self.shell("hc marker %s --in image=%s.mtp | hc cat --json" % (names, eye))
            coords = {json.loads(line)["coord"] for line in out.splitlines()}
            self.assertLessEqual({number + 101, number + 103}, coords)

    def test_the_ball_is_where_it_is_seen(self):
        for noise in (0, 20):
            with self.subTest(noise=noise):
                self.simulate("--noise %d" % noise, left="left.mtp", ball_seen="seen.mtp")
                seen = self.messages("cat seen.mtp")
                lines = self.shell("hc blob --in image=left.mtp --out target=- | hc cat --json")
                found = [json.loads(line)["elements"][0][0] for line in lines.splitlines()]
                self.assertEqual(len(found), len(seen))
                for blob, truth in zip(found, seen):
                    self.assertLess(math.dist(blob[:2], truth[:2]), 1.5, "px")
                    self.assertLess(abs(blob[2] - truth[2]), 2, "px")

    def test_the_loudspeaker_is_heard_from_the_right(self):
        self.simulate("--count 60", sound="sound.mtp")
        self.shell("hc hearing --in sound.mtp --out level=level.mtp --out direction=direction.mtp")
        levels = [row[0] for row in self.messages("cat level.mtp")]
        self.assertEqual(len(levels), self.shell("hc cat --json sound.mtp").count("\n"))
        self.assertGreater(max(levels), 0.01)
        self.assertEqual(min(levels), 0)  # between its sounds
        pans = sorted(row[0][2] for row in self.messages("cat direction.mtp"))
        self.assertGreater(len(pans), len(levels) // 10)
        self.assertLess(pans[len(pans) // 2], -math.radians(30))

    def test_an_absent_ball_is_not_found(self):
        self.simulate("--ball absent --noise 20", left="left.mtp")
        self.assertEqual(self.shell("hc blob --in image=left.mtp"), "")

    def test_a_camera_that_is_assumed_is_named(self):
        self.simulate("--ball absent", left="left.mtp", right="right.mtp", depth="depth.mtp")
        self.shell(
            "hc rectify --focal 600 --in left=left.mtp --in right=right.mtp "
            "--out left=l.mtp --out right=r.mtp --out intrinsics=i.mtp"
        )
        target = "1 1 0 0 8 0 10390 0 7 1 1\n1 2 0\n"
        self.write("pixel.mtp", target)
        pair = "--in left=l.mtp --in right=r.mtp"
        raw = "--in left=left.mtp --in right=right.mtp"
        objects = "--in left=left.mtp --in right=right.mtp --in depth=depth.mtp --out corners=c.mtp"
        for command, focal, baseline, remedy in (
            (
                "depth %s --out depth=d.mtp" % pair,
                "--focal 600",
                "--baseline 0.1",
                "link intrinsics",
            ),
            ("augment " + objects, "--focal 600", "--baseline 0.1", "link intrinsics"),
            (
                "marker --in image=left.mtp --out poses=p.mtp",
                "--focal 600",
                "",
                "set calibration_file",
            ),
            (
                "rectify %s --out left=a.mtp" % raw,
                "--focal 600",
                self.FRAMES,
                "set calibration_file",
            ),
            (
                "gaze --in target=pixel.mtp --out bid=b.mtp",
                "--focal 600",
                "--cx 9 --cy 9",
                "set calib",
            ),
        ):
            with self.subTest(command=command):
                said = self.shell("hc %s 2>&1" % command)
                self.assertEqual(len(re.findall("assumed: .*" + remedy, said)), 1, said)
                if baseline:
                    said = self.shell("hc %s %s 2>&1" % (command, focal))
                    self.assertEqual(len(re.findall("assumed: .*" + remedy, said)), 1, said)
                said = self.shell("hc %s %s %s 2>&1" % (command, focal, baseline))
                self.assertNotIn("assumed", said)
        for command in ("depth %s --out depth=d.mtp" % pair, "augment " + objects):
            said = self.shell("hc %s --in intrinsics=i.mtp 2>&1" % command)
            self.assertNotIn("assumed", said)

    def test_an_ideal_pair_that_is_rectified_gives_the_depth(self):
        options = "--focal 600 --noise 2 --encoding depth=text"
        self.simulate(options, left="left.mtp", right="right.mtp", depth="truth.mtp")
        self.shell(
            "hc rectify --focal 600 --in left=left.mtp --in right=right.mtp "
            "--out left=l.mtp --out right=r.mtp --out intrinsics=i.mtp"
        )
        self.assertEqual(self.messages("head -n 2 i.mtp")[0], [600, 600, 399.5, 299.5, 0.1])
        for name in ("l.mtp", "r.mtp"):
            self.assertIn("rgb_image 800 x 600", self.shell("hc info " + name))
        # The disparities of an ideal pair are its depth: 600 px · 0.1 m / disparity.
        found = self.shell(
            "hc depth --focal 600 --baseline 0.1 --disparities 48 --in left=l.mtp --in right=r.mtp "
            "--out depth=- --encoding text | awk 'NF == 800 { print $400 }'"
        )
        truth = self.shell("awk 'NF == 800 { print $400 }' truth.mtp")
        pairs = [(float(a), float(b)) for a, b in zip(found.split(), truth.split()) if float(a) > 0]
        self.assertGreater(len(pairs), 900)
        close = sum(abs(a - b) < 0.05 * b for a, b in pairs)
        self.assertGreater(close, 0.9 * len(pairs))


if __name__ == "__main__":
    unittest.main()
