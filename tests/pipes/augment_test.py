#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What augment draws into the images of the simulated room, compared with where it would be seen."""

import base64
import json
import math
import struct
import unittest
import zlib

from sight import Sight

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


class Augment(Sight):
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

    def look_ahead(self):
        options = "--ball absent --count 1"
        self.simulate(options, left="left.mtp", right="right.mtp", depth="depth.mtp")

    def tag_of(self, faces, names="1 Anna"):
        """Columns and rows of the left image that tags cover, the first and the last [px], and what
        is said. @param faces  rows of a table: person, x, y, z in the head's frame."""
        width = 21 + max(map(len, faces), default=4) - 1
        rows = [" ".join(map(str, [0] * 5 + [1, face[0]] + [0] * 14 + face[1:])) for face in faces]
        header = "1 1 0 0 8 950000000 120190 0 9 %d %d" % (width, len(faces))
        self.write("faces.mtp", "\n".join([header, *rows]) + ("\n" if rows else "\n\n"))
        names = names if isinstance(names, bytes) else names.encode()
        self.write("names.mtp", b"1 1 0 0 8 1 60100 0 0 %d 1\n%b\n" % (len(names), names))
        links = "--objects '' --clock messages --in faces=faces.mtp --in names=names.mtp"
        self.shell(self.augment(links, "mask=- >mask.mtp 2>said"))
        mask = self.read_bytes("mask.mtp").split(b"\n", 1)[1]
        places = [i for i, each in enumerate(mask[:480000]) if each > 127] or [0]
        columns = [i % 800 for i in places]
        return (min(columns), max(columns), places[0] // 800, places[-1] // 800), self.read("said")

    def test_a_tag_is_over_a_face_whose_person_has_a_name(self):
        self.look_ahead()
        # The left eye is 0.06 m ahead, 0.05 m to the left and 0.05 m above the head's origin.
        (left, right, top, bottom), _ = self.tag_of([[1, 1.56, 0.05, 0.05]])
        self.assertAlmostEqual((left + right) / 2, 399.5, delta=3)
        self.assertAlmostEqual((top + bottom) / 2, 299.5 - 600 * 0.22 / 1.5, delta=3)
        nobody = (0, 0, 0, 0)
        for faces in ([], [[0, 1.56, 0.05, 0.05]], [[2, 1.56, 0.05, 0.05]], [[1, 9, 0.05, 0.05]]):
            with self.subTest(faces=faces):
                self.assertEqual(self.tag_of(faces)[0], nobody)

    def test_bad_faces_and_names_are_said_or_ignored(self):
        self.look_ahead()
        good = [1, 1.56, 0.05, 0.05]
        seen, said = self.tag_of([good])
        self.assertNotIn("faces", said)
        for bad in ([1, -2, 0, 0], [1e300, 2, 0, 0], [-1, 2, 0, 0], [1, 0, 0, 0], [1, 1e9, 0, 0]):
            with self.subTest(bad=bad):
                self.assertEqual(self.tag_of([bad, good])[0], seen)
        self.assertIn("faces: ", self.tag_of([[1, "nan", 0.05, 0.05]])[1])
        self.assertIn("faces: ", self.tag_of([good + [0]])[1])
        for names in (b"x\n1 Anna", b"\n1 Anna", b"1 Anna\n9999999999999 Ben"):
            with self.subTest(names=names):
                found, said = self.tag_of([good], names)
                self.assertEqual(found, seen)
                self.assertIn("is not PERSON NAME", said)
        for names in (b"1 \xff\xfe\x1b[2J", b"1 " + b"a" * 100000):
            found, said = self.tag_of([good], names)
            self.assertGreater(found[1] - found[0], seen[1] - seen[0])
            self.assertNotIn("names", said)

    def test_images_pass_where_there_is_nothing_to_draw(self):
        self.simulate("", left="left.mtp", right="right.mtp", depth="depth.mtp")
        self.shell(self.augment("--objects ''", "left=augmented.mtp"))
        passed, taken = (self.shell("hc cat --json <%s" % f) for f in ("augmented.mtp", "left.mtp"))
        self.assertEqual(passed, taken)


if __name__ == "__main__":
    unittest.main()
