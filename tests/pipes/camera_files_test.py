#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The module camera with files: their order, which belong together, and the times of videos."""

import json
import time
import unittest

from harness import DATA, PYTHON, Pipes, WATCHDOG, messages_of

# This video is not encoded at a fixed rate: the times of its first images [ms].
TREE = DATA + "/tree.avi"
TIMES = [0, 733.337, 1133.339, 1600.008]


class CameraFiles(Pipes):
    def images(self, command):
        return [json.loads(line) for line in self.shell(command + " | hc cat --json").splitlines()]

    def spacing(self, images):
        """The times of images since the first [ms]."""
        return [(int(each["time"]) - int(images[0]["time"])) / 1e6 for each in images]

    def assert_near(self, times, expected):
        self.assertEqual(len(times), len(expected), times)
        for one, other in zip(times, expected):
            self.assertAlmostEqual(one, other, delta=0.01)

    def video(self, options):
        return "hc camera %s --width 4 --height 4 %s" % (TREE, options)

    def test_a_video_plays_at_its_own_times(self):
        before = time.time_ns()
        images = self.images(self.video("--count 4"))
        self.assert_near(self.spacing(images), TIMES)
        self.assertGreater(time.time_ns() - before, TIMES[-1] * 1e6)
        self.assertTrue(before < int(images[0]["time"]) < time.time_ns() - TIMES[-1] * 1e6)

    def test_as_fast_as_it_is_read_it_has_the_same_times(self):
        images = self.images(self.video("--paced=false"))
        times = self.spacing(images)
        self.assertEqual(len(images), 68)
        self.assert_near(times[:4], TIMES)
        self.assertEqual(times, sorted(set(times)))
        # Its last image has not been shown by the clock.
        self.assertGreater(int(images[-1]["time"]), time.time_ns())

    def test_a_video_is_thinned_out_to_a_rate(self):
        images = self.images(self.video("--paced=false --rate 1"))
        times = self.spacing(images)
        distances = [b - a for a, b in zip(times, times[1:])]
        self.assertTrue(all(each > 700 for each in distances), distances)
        self.assertLess(max(times) / (len(times) - 1), 1200)

    def test_a_video_that_starts_again_counts_on(self):
        times = self.spacing(self.images(self.video("--paced=false --loop --count 140")))
        self.assertEqual(times, sorted(set(times)))
        self.assert_near([each - times[68] for each in times[68:72]], TIMES)

    def test_a_long_pause_of_a_video_is_skipped(self):
        """A stream of which parts were put together, in Matroska: its times are free."""
        self.draw(
            """
import cv2, numpy, struct

def element(name, *parts):
    content = b"".join(parts)
    return bytes.fromhex(name) + struct.pack(">Q", 1 << 56 | len(content)) + content

number = lambda value: struct.pack(">Q", value)
track = element("ae", element("d7", number(1)), element("73c5", number(1)), element("83", b"\\1"),
    element("86", b"V_MJPEG"), element("e0", element("b0", number(32)), element("ba", number(32))))
clusters = []
for i, at in enumerate((0, 100, 200, 600200, 600300)):  # [ms]
    _, jpeg = cv2.imencode(".jpg", numpy.full((32, 32, 3), 50 * i, numpy.uint8))
    block = element("a3", b"\\x81\\0\\0\\x80" + jpeg.tobytes())
    clusters.append(element("1f43b675", element("e7", number(at)), block))
header = element("1a45dfa3", element("4282", b"matroska"), element("4287", b"\\4"), element("4285", b"\\2"))
info = element("1549a966", element("2ad7b1", number(10**6)))
segment = element("18538067", info, element("1654ae6b", track), *clusters)
open("gap.mkv", "wb").write(header + segment)"""
        )
        times = self.spacing(self.images("hc camera gap.mkv --width 4 --height 4"))
        self.assertIn("camera: skipping a pause of 600 s in the video", self.err)
        self.assert_near(times, [0, 100, 200, 600200, 600300])

    def test_two_videos_are_paired_by_their_times(self):
        """One eye has a third of the images of the other."""
        self.draw(
            """
def write(name, rate, step):
    video = cv2.VideoWriter(name, cv2.VideoWriter_fourcc(*"MJPG"), rate, (32, 32))
    for i in range(0, 60, step):
        video.write(numpy.full((32, 32, 3), 4 * i, numpy.uint8))
write("left.avi", 30, 1)
write("right.avi", 10, 3)"""
        )
        out = self.shell(
            "hc camera left.avi right.avi --width 1 --height 1 --paced=false --encoding text"
        )
        rows = [line.split() for line in out.splitlines()]
        left = [int(row[0]) for header, row in zip(rows, rows[1:]) if header[:2] == ["1", "1"]]
        right = [int(row[0]) for header, row in zip(rows, rows[1:]) if header[:2] == ["1", "2"]]
        self.assertGreaterEqual(len(left), 18)
        self.assertEqual(len(left), len(right))
        for one, other in zip(left, right):
            self.assertAlmostEqual(one, other, delta=3)

    def save(self, folder, values, numbers=None):
        """Images of these values, as hc view saves them; their numbers are the values, or given."""
        messages = "".join(
            "1 1 0 %d 8 0 30300 0 7 1 1\n%d 0 0\n" % each for each in zip(numbers or values, values)
        )
        self.shell("hc view --save %s/ --window no" % folder, data=messages.encode())

    def seen(self, command):
        """The first values of the images of each eye."""
        eyes = {}
        for message in messages_of(self.shell(command + " --stamped=false --encoding text")):
            eyes.setdefault(str(message.src), []).append(message.rows[0][0])
        return eyes

    def test_saved_images_are_read_in_the_order_of_their_numbers(self):
        self.save("all", range(8, 112))
        self.assertEqual(self.seen("hc camera all"), {"1": list(range(8, 112))})

    def test_saved_images_of_a_source_that_starts_again_follow_those_before(self):
        for values in ([10, 11, 12], [20, 21], [30, 31, 32, 33]):
            self.save("all", values, range(len(values)))
        values = [10, 11, 12, 20, 21, 30, 31, 32, 33]
        self.assertEqual(self.seen("hc camera all"), {"1": values})

    def test_images_of_two_folders_belong_together_by_their_numbers(self):
        self.save("left", [1, 2, 3, 9, 10, 11])
        self.save("right", [1, 2, 4, 9, 10, 12])
        together = [1, 2, 9, 10]
        self.assertEqual(self.seen("hc camera left right"), {"1": together, "2": together})
        self.assertEqual(
            self.err,
            "camera: warning: 4 images without a partner, not sent:"
            " left/1_3.png left/1_11.png right/1_4.png right/1_12.png\n",
        )

    def test_images_that_do_not_belong_together_are_refused(self):
        self.save("left", [1, 2])
        self.save("right", [3, 4])
        self.shell("hc camera left right", status=2)
        self.assertEqual(
            self.err,
            "camera: Invalid: right: no image has the name or the number of one in left\n",
        )

    def draw(self, script):
        """Runs a script with OpenCV and NumPy."""
        self.shell("%s -c 'import cv2, numpy\n%s'" % (PYTHON, script))

    def test_libraries_print_no_lines_of_their_own(self):
        self.shell("head -c 5000 $HC_DATA/tree.avi >cut.avi; echo text >text.mp4")
        for name in ("cut.avi", "text.mp4"):
            process = self.start("exec hc camera %s --count 1 >/dev/null" % name)
            _, log = process.communicate(timeout=WATCHDOG)
            for line in log.decode().splitlines():
                self.assertRegex(line, "^camera: ")

    def test_a_jpeg_that_is_cut_is_refused(self):
        self.shell("head -c 30000 $HC_DATA/aloeL.jpg >cut.jpg; hc camera cut.jpg", status=2)
        self.assertEqual(self.err, "camera: Invalid: cut.jpg: Premature end of JPEG file\n")

    def test_image_files_of_all_kinds(self):
        kinds = ("bmp", "jp2", "jpg", "png", "ppm", "tiff", "webp")
        self.draw(
            """
for kind in ("%s"):
    cv2.imwrite("grey." + kind, numpy.full((64, 64, 3), 90, numpy.uint8))"""
            % '", "'.join(kinds)
        )
        for kind in kinds:
            with self.subTest(kind):
                (value,) = self.seen("hc camera grey." + kind)["1"]
                self.assertAlmostEqual(value, 90, delta=2)
                self.assertEqual(self.err, "")

    def test_sixteen_bits_become_eight_with_a_word(self):
        self.draw('cv2.imwrite("deep.png", numpy.full((1, 1), 2570, numpy.uint16))')
        self.assertEqual(self.seen("hc camera deep.png"), {"1": [10]})
        self.assertIn("camera: deep.png: 16 bits a channel, divided by 257 to 8", self.err)

    def test_an_image_is_turned_as_its_exif_data_says_unless_it_is_calibrated(self):
        self.draw('cv2.imwrite("plain.jpg", numpy.full((16, 32, 3), 90, numpy.uint8))')
        plain = self.read_bytes("plain.jpg")
        # An EXIF segment whose only entry is the orientation, 6: turned by a quarter.
        entry = b"\x01\x12\0\x03\0\0\0\x01\0\x06\0\0"
        exif = b"Exif\0\0MM\0*\0\0\0\x08\0\x01" + entry + b"\0\0\0\0"
        segment = b"\xff\xe1" + (len(exif) + 2).to_bytes(2, "big") + exif
        self.write("turned.jpg", plain[:2] + segment + plain[2:])
        for options, size in (
            ("", (16, 32)),
            ("--upright=false", (32, 16)),
            ("--rectified", (32, 16)),
            ("--side_by_side", (16, 16)),
            ("--right_source turned.jpg", (32, 16)),
        ):
            for image in self.images("hc camera turned.jpg " + options):
                self.assertEqual((image["width"], image["height"]), size, options)


if __name__ == "__main__":
    unittest.main()
