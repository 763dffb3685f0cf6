#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The module read before the simulator's board; with HC_FULL=1, over many seeds."""

import json
import os
import pathlib
import random
import sys
import unittest

from harness import BUILD, Pipes, ROOT, WATCHDOG, wait_until

sys.path.insert(0, str(ROOT / "bench"))
import words  # noqa: E402

ROOM_TIME = 10**18  # of the first image [ns]; any time will do, and so it is the same each time
LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
SEEDS = range(1, 21 if os.environ.get("HC_FULL") == "1" else 4)


def random_text(seed):
    """Letters and digits, 5 to 16 with a space in some, as on the board of a seed."""
    draw = random.Random(seed)
    length = draw.randint(5, 16)
    text = [draw.choice(LETTERS) for _ in range(length)]
    if length > 8 and draw.random() < 0.5:
        text[draw.randint(3, length - 4)] = " "
    return "".join(text)


class Read(Pipes):
    def read_board(self, text, seed, noise, images=4, options=""):
        """What is read in so many images of the board: the texts given, confidences and targets."""
        self.shell("rm -f eye text sure target")
        self.shell("hc send --type rotation 0 -0.04 0.3 --coord 13 --time %d >gaze" % ROOM_TIME)
        self.shell(
            "hc simulator --paced=false --count %d --start %d --text '%s' --seed %d --noise %g"
            " --in gaze=gaze --out left=eye" % (images, ROOM_TIME, text, seed, noise)
        )
        self.shell(
            "hc read --rate 0 %s --in image=eye --out text=text --out confidence=sure"
            " --out target=target" % options
        )
        found = {}
        for name in ("text", "sure", "target"):
            lines = self.shell("hc cat --json ./%s" % name).splitlines()
            found[name] = [json.loads(line)["elements"][0] for line in lines]
        return found

    def error_rate(self, noise):
        """Of the letters of the first text that is given, over many seeds."""
        wrong = letters = 0
        for seed in SEEDS:
            truth = random_text(seed)
            found = self.read_board(truth, seed, noise, images=6)
            wrong += words.edits(truth, found["text"][0] if found["text"] else "")
            letters += len(truth)
        print("noise %g: character error rate %.2f %%" % (noise, 100 * wrong / letters))
        return wrong / letters

    def test_a_clean_board_is_read_without_an_error(self):
        self.assertEqual(self.error_rate(noise=0), 0)

    def test_noise_of_20_costs_five_letters_of_a_hundred_at_most(self):
        self.assertLessEqual(self.error_rate(noise=20), 0.05)

    def test_the_target_is_where_the_board_is(self):
        found = self.read_board("LOOK HERE", seed=2, noise=5)
        self.assertEqual(found["text"], ["LOOK HERE"])
        self.assertEqual(len(found["target"]), 4)
        x, y, width = found["target"][0][0]
        # At pan 0.3, tilt -0.04, focal length 600: the board is within 0.2 rad of the middle.
        self.assertLess(abs(x - 399.5), 120)
        self.assertLess(abs(y - 299.5), 120)
        # 1.5 m of board at 3.5 m are 257 pixels, of which the letters take up to nine tenths.
        self.assertTrue(100 < width < 240, width)

    def test_the_target_comes_with_images_that_are_not_read(self):
        found = self.read_board("LOOK HERE", 2, 0, images=6, options="--rate 5 --repeat 1")
        # Images of 20 Hz, of which each fourth is read.
        self.assertEqual((len(found["target"]), len(found["sure"])), (6, 2))

    def test_what_is_not_sure_enough_is_a_target_and_no_text(self):
        found = self.read_board("LOOK HERE", 2, 0, options="--confidence 1")
        self.assertEqual((found["text"], len(found["target"])), ([], 4))

    def test_an_empty_wall_gives_nothing(self):
        self.shell(
            "hc simulator --paced=false --count 2 --start 1000000000000000000 --noise 20"
            " --text '' --out left=eye.mtp --in gaze=/dev/null"
        )
        self.assertEqual(self.shell("hc read --in image=eye.mtp | hc cat"), "")

    def draw(self, text, font, size=40):
        """An image of 800 x 600 with a text in a TrueType font, by Graphviz; gives its name."""
        node = (
            'graph { graph [size="8.3333,6.25!", dpi=96, margin=0, pad=0]; n [shape=plaintext,'
            'label="%s", fontname="%s", fontsize=%d, width=8.33, height=6.25, fixedsize=true] }'
        )
        self.shell("dot -Tpng -o drawn.png", data=(node % (text, font, size)).encode())
        return "drawn.png"

    def test_words_in_real_fonts_are_read_without_an_error(self):
        fonts = [
            "Liberation Sans",
            "Liberation Sans Bold",
            "Liberation Mono",
            "Liberation Serif",
            "DejaVu Sans",
            "DejaVu Sans Bold",
        ]
        for font in fonts:
            for text in ("STOP AT LAB 4", "OLD ROBOT 2"):
                for size in (40, 20):
                    with self.subTest(font=font, text=text, size=size):
                        image = self.draw(text, font, size)
                        read = self.shell(
                            "hc camera --source %s --loop --count 2 | hc read --rate 0 --in image=-"
                            " --out text=- | hc cat --json" % image
                        )
                        lines = [json.loads(line)["elements"][0] for line in read.splitlines()]
                        self.assertEqual(lines, [text])

    @unittest.skipUnless(words.FOLDER.exists(), "opencv-doc has no photographs of text")
    def test_words_that_are_cropped_from_photographs_are_read(self):
        folder = pathlib.Path(self.folder.name)
        for crops, most in ((words.SEEN, 4), (words.UNSEEN[:10], 6)):
            pairs = []
            for image, box, truth in crops:
                words.crop(BUILD / "bin/hc", image, box, self.path("word.ppm"))
                pairs.append((truth, words.read_word(BUILD / "bin/hc", folder)))
            self.assertLess(words.error_rate(pairs), most, pairs)

    def test_text_of_a_time_without_focus_is_said_again_in_focus(self):
        self.draw("LOOK HERE", "DejaVu Sans")
        self.shell("hc camera --source drawn.png --count 1 --out left=eye.mtp")
        image = pathlib.Path(self.path("eye.mtp")).read_bytes()
        os.mkfifo(self.path("focus"))
        focus = [self.shell("hc send --type table --scalar i32 %d" % mode) for mode in (2, 1)]
        command = "hc read --rate 0 --mode 1 --in image=- --in focus=focus --out text=text.mtp"
        read = self.start(command, stdin=-1)
        said = pathlib.Path(self.path("text.mtp"))

        def count_said():
            return said.read_bytes().count(b"LOOK HERE") if said.exists() else 0

        def is_said(times):
            # Each image has the same time, so that none is due again.
            read.stdin.write(image)
            read.stdin.flush()
            return count_said() >= times

        with open(self.path("focus"), "wb", buffering=0) as link:
            link.write(focus[0].encode())
            wait_until(lambda: is_said(1))
            link.write(focus[1].encode())
            wait_until(lambda: is_said(2))
        read.communicate(timeout=WATCHDOG)
        self.assertEqual(count_said(), 2)

    def test_a_language_that_is_missing_is_one_line(self):
        self.shell("hc read --language no_such --in image=/dev/null", status=2)
        self.assertEqual(len(self.err.splitlines()), 1, self.err)
        self.assertIn("Tesseract has no language no_such", self.err)


if __name__ == "__main__":
    unittest.main()
