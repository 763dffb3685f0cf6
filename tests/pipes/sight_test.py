#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the eyes' modules see of the simulated room, compared with how it is."""

import base64
import json
import math
import os
import re
import struct
import unittest
import zlib

from harness import Pipes, ROOT


def turn(q, v):
    """A vector, turned by a quaternion x y z w."""
    x, y, z, w = q
    t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])]
    return [
        v[0] + w * t[0] + y * t[2] - z * t[1],
        v[1] + w * t[1] + z * t[0] - x * t[2],
        v[2] + w * t[2] + x * t[1] - y * t[0],
    ]


# A stick of 2 m along x, in the format of Wavefront.
STICK = """
v -1 -0.01 -0.01
v 1 -0.01 -0.01
v 1 0.01 -0.01
v -1 0.01 -0.01
v -1 -0.01 0.01
v 1 -0.01 0.01
v 1 0.01 0.01
v -1 0.01 0.01
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
"""


def png(rgb):
    """An image of one pixel."""

    def chunk(kind, data):
        return (
            struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        )

    header = struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0)
    pixels = zlib.compress(b"\0" + bytes(rgb))
    return (
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", pixels) + chunk(b"IEND", b"")
    )


def gltf_parts(rgb):
    """A square of 1 m that looks along -x, with an image of one colour on it: its description in
    glTF, and its bytes."""
    places = [0, -0.5, -0.5, 0, 0.5, -0.5, 0, 0.5, 0.5, 0, -0.5, 0.5]
    pieces = [
        struct.pack("<12f", *places),
        struct.pack("<8f", 0, 0, 1, 0, 1, 1, 0, 1),
        struct.pack("<6H", 0, 2, 1, 0, 3, 2),
        png(rgb),
    ]
    views, data = [], b""
    for piece in pieces:
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(piece)})
        data += piece + bytes(-len(piece) % 4)
    bounds = {"min": [0, -0.5, -0.5], "max": [0, 0.5, 0.5]}
    model = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [
            {
                "primitives": [
                    {
                        "attributes": {"POSITION": 0, "TEXCOORD_0": 1},
                        "indices": 2,
                        "material": 0,
                    }
                ]
            }
        ],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}],
        "images": [{"bufferView": 3, "mimeType": "image/png"}],
        "accessors": [
            dict(bounds, bufferView=0, componentType=5126, count=4, type="VEC3"),
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": views,
    }
    return model, data


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

    FRAMES = (
        "--frames 'left_eye 4 head 0 0 0 0 0 0 1; right_eye 5 left_eye 0.1 0 0 0 0 0 1; "
        "head 3 world 0 0 0 0 0 0 1'"
    )

    def messages(self, command):
        """The rows of each message."""
        lines = self.shell(command + " | hc cat --json").splitlines()
        return [row for line in lines for row in json.loads(line)["elements"]]

    @staticmethod
    def in_left_eye(place):
        return [0.05 - place[1], 1.25 - place[2], place[0] - 0.06]

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

    def augment(self, options, output):
        links = " ".join("--in %s=%s.mtp" % (name, name) for name in ("left", "right", "depth"))
        return "hc augment --focal 600 %s %s --out %s" % (links, options, output)

    def corners_of(self, place, size):
        """Where the corners of a box are seen by both eyes [px], the head looking straight ahead."""
        for z in (-size / 2, size / 2):
            for y in (-size / 2, size / 2):
                for x in (-size / 2, size / 2):
                    p = self.in_left_eye([place[0] + x, place[1] + y, place[2] + z])
                    yield [
                        399.5 + 600 * p[0] / p[2],
                        299.5 + 600 * p[1] / p[2],
                        399.5 + 600 * (p[0] - 0.1) / p[2],
                        299.5 + 600 * p[1] / p[2],
                    ]

    def test_an_object_is_drawn_where_it_would_be_seen(self):
        self.simulate("--ball absent", left="left.mtp", right="right.mtp", depth="depth.mtp")
        cube = "--objects 'cube at world 2 0.1 1.2 size 0.3'"
        found = self.messages(self.augment(cube, "corners=-"))
        truth = list(self.corners_of([2, 0.1, 1.2], 0.3)) * 3
        self.assertEqual(len(found), len(truth))
        for corner, true_corner in zip(found, truth):
            self.assertLess(math.dist(corner, true_corner), 0.01)

    def turn_head(self, seconds, speed):
        """What a head says that begins to turn to the left at 1 s, [rad/s]: its gaze, 200 times a
        second, and as often as a pan-tilt unit on a slow line, its pose."""
        gaze, pose = [], []
        for ms in range(0, 1000 * seconds + 100, 5):
            time, pan = 1_000_000_000 + 1_000_000 * ms, speed * ms / 1000
            gaze.append("1 0 0 %d 8 %d 20390 13 0 1 1\n0 0 %.9f\n" % (ms, time, pan))
            if ms % 45 == 0:
                c, s = math.cos(pan), math.sin(pan)
                pose.append("1 1 0 %d 8 %d 70190 0 2003 4 4\n" % (ms, time))
                pose.append("%.9f %.9f 0 0\n%.9f %.9f 0 0\n0 0 1 0\n0 0 0 1\n" % (c, -s, s, c))
        self.write("gaze.mtp", "".join(gaze))
        self.write("pose.mtp", "".join(pose))

    def test_an_object_stays_where_it_is_while_the_head_turns(self):
        self.turn_head(1, math.radians(60))
        self.simulate(
            "--count 20 --ball absent --in gaze=gaze.mtp",
            left="left.mtp",
            right="right.mtp",
            depth="depth.mtp",
            left_pose="left_pose.mtp",
        )
        cube = "--objects 'cube at world 2 0.9 1.2 size 0.3' --in frames=pose.mtp --clock messages"
        found = self.messages(self.augment(cube, "corners=-"))
        poses = self.messages("cat left_pose.mtp")
        self.assertEqual(len(found), 8 * 20)
        errors = []
        for i, corner in enumerate(found):
            eye = poses[4 * (i // 8) : 4 * (i // 8) + 4]
            bits = [(i >> bit) & 1 for bit in range(3)]
            world = [m + 0.3 * (b - 0.5) for m, b in zip((2, 0.9, 1.2), bits)]
            away = [w - row[3] for w, row in zip(world, eye)]
            p = [sum(eye[k][axis] * away[k] for k in range(3)) for axis in range(3)]
            truth = [399.5 + 600 * p[0] / p[2], 299.5 + 600 * p[1] / p[2]]
            errors.append(math.dist(corner[:2], truth))
        self.assertLess(max(errors), 0.01, "px")

    def test_an_object_stands_on_a_marker(self):
        self.simulate(
            "--seed 1", left="left.mtp", right="right.mtp", depth="depth.mtp", markers="m.mtp"
        )
        self.shell(
            "hc marker --marker_frames colour:300=103 --sides colour:300=0.14 --focal 600 "
            "--in image=left.mtp --out poses=poses.mtp"
        )
        cube = "--objects 'cube at 103 size 0.14' --in poses=poses.mtp --clock messages"
        found = self.messages(self.augment(cube, "corners=-"))
        marker = next(row for row in self.messages("cat m.mtp") if row[1] == 300)
        truth = list(self.corners_of(marker[3:6], 0))[0]
        middle = [sum(corner[i] for corner in found[-8:]) / 8 for i in range(4)]
        self.assertLess(math.dist(middle, truth), 2, "px")

    def test_an_object_is_held_between_two_markers(self):
        self.simulate(
            "--seed 1", left="left.mtp", right="right.mtp", depth="depth.mtp", markers="m.mtp"
        )
        self.shell(
            "hc marker --marker_frames 'colour:300=103 colour:120=104' --focal 600 "
            "--sides 'colour:300=0.14 colour:120=0.12' --in image=left.mtp --out poses=poses.mtp"
        )
        ends = [
            next(row for row in self.messages("cat m.mtp") if row[1] == hue)[3:6]
            for hue in (300, 120)
        ]
        self.write("stick.obj", STICK)
        length = math.dist(*ends)
        middle = [sum(pair) / 2 for pair in zip(*ends)]
        for size, share in (("fit", 1), ("0.3", 0.3 / length)):
            with self.subTest(size=size):
                stick = "--objects 'stick.obj at 103 to 104 size %s' --clock messages" % size
                found = self.messages(self.augment(stick + " --in poses=poses.mtp", "corners=-"))
                for number, end in enumerate(ends):  # its x axis goes from the first to the second
                    tip = [m + share * (e - m) for e, m in zip(end, middle)]
                    truth = list(self.corners_of(tip, 0))[0]
                    corners = [found[-8 + i] for i in range(8) if i % 2 == number]
                    seen = [sum(corner[i] for corner in corners) / 4 for i in range(4)]
                    self.assertLess(math.dist(seen, truth), 3, "px")

    def test_what_is_before_an_object_hides_it(self):
        self.simulate("--ball absent", left="left.mtp", right="right.mtp", depth="depth.mtp")
        for place, is_seen in (("2.0 0.1 1.2", True), ("9.0 0.1 1.2", False)):
            with self.subTest(place=place):
                cube = "--objects 'cube at world %s size 0.3'" % place
                masks = self.messages(self.augment(cube, "mask=-"))
                self.assertEqual(max(max(row) for row in masks) == 255, is_seen)

    def test_models_in_gltf_have_their_place_and_colour(self):
        model, data = gltf_parts((20, 220, 60))
        model["buffers"] = [{"byteLength": len(data)}]
        text = json.dumps(model).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        chunks += struct.pack("<I4s", len(data), b"BIN\0") + data
        self.write("square.glb", struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
        uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
        model["buffers"][0]["uri"] = uri
        self.write("square.gltf", json.dumps(model))
        options = "--ball absent --count 1"
        self.simulate(options, left="left.mtp", right="right.mtp", depth="depth.mtp")
        for name in ("square.glb", "square.gltf"):
            with self.subTest(name=name):
                square = "--objects '%s at world 1.5 0.05 1.25 size 0.4'" % name
                self.shell(self.augment(square, "left=augmented.mtp"))
                rows = self.messages("cat augmented.mtp")
                # 0.4 m at 1.44 m before the left eye are 167 px.
                for x, y, is_square in (
                    (400, 300, True),
                    (325, 225, True),
                    (475, 375, True),
                    (300, 300, False),
                    (400, 200, False),
                ):
                    red, green, blue = rows[y][x]
                    is_green = green > 100 and red < green / 4 and blue < green / 2
                    self.assertEqual(is_green, is_square, (x, y, red, green, blue))

    def test_how_sure_depth_is_is_shown_of_the_cursor(self):
        self.simulate("--count 1", left="left.mtp", right="right.mtp", depth="depth.mtp")
        header = b"1 1 0 0 8 1 40101 0 12 800 600\n"
        at = 200 * 800 + 100
        maps = {
            "unsure": bytes(480000),
            "unsure_there": b"\xff" * at + b"\0" + b"\xff" * (480000 - at - 1),
            "sure": b"\xff" * 480000,
        }
        shown = {}
        options = "--objects '' --instruments confidence --cursor_x 100 --cursor_y 200 "
        for name, pixels in maps.items():
            self.write(name + ".mtp", header + pixels + b"\n")
            link = "--in confidence=%s.mtp --clock messages" % name
            self.shell(self.augment(options + link, "left=%s_shown.mtp" % name))
            shown[name] = self.read_bytes(name + "_shown.mtp")
        self.assertEqual(shown["unsure"], shown["unsure_there"])
        self.assertNotEqual(shown["unsure"], shown["sure"])

    def test_images_pass_where_there_is_nothing_to_draw(self):
        self.simulate("", left="left.mtp", right="right.mtp", depth="depth.mtp")
        self.shell(self.augment("--objects ''", "left=augmented.mtp"))
        passed, taken = (self.shell("hc cat --json <%s" % f) for f in ("augmented.mtp", "left.mtp"))
        self.assertEqual(passed, taken)

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


class Pipeline(Pipes):
    def run_pipeline(self, keep, *settings):
        self.environment["HC_KEEP"] = keep
        words = "".join(" --set " + setting for setting in settings)
        out = self.shell("hc run %s/graphs/pipeline.toml --links --quiet%s" % (ROOT, words))
        self.assertEqual(os.listdir(self.folder.name), [])
        return {
            link: int(count)
            for link, count in re.findall(r"^(\S+ → \S+) +(\d+) messages? ", out, re.M)
        }

    def test_every_pair_goes_through_where_none_is_to_be_dropped(self):
        links = self.run_pipeline("all", "camera.rate=0", "camera.count=12")
        for link in ("camera.left → rectify.left", "rectify.right → depth.right"):
            self.assertEqual(links[link], 12, links)
        self.assertEqual(links["depth.depth → augment.depth"], 12, links)
        self.assertEqual(links["augment.right → view.image"], 12, links)

    def test_a_slow_module_takes_the_newest_and_no_other_waits_for_it(self):
        settings = "depth.matcher=opencv", "camera.rate=40", "camera.count=40"
        links = self.run_pipeline("latest", *settings)
        self.assertGreater(
            links["camera.left → rectify.left"], links["depth.depth → augment.depth"]
        )
        self.assertLess(links["augment.left → view.image"], links["rectify.left → depth.left"])


if __name__ == "__main__":
    unittest.main()
