#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""words.py BUILD: characters that the module `read` and the program tesseract get wrong in words
cropped from photographs (of Debian's opencv-doc), and `read` of the simulated head's board.

The settings of `read` were chosen by the first ten crops."""

import json
import os
import pathlib
import random
import shutil
import string
import subprocess
import sys
import tempfile

DATA = os.environ.get("HC_DATA", "/usr/share/doc/opencv-doc/examples/data")
FOLDER = pathlib.Path(DATA).parent / "text"
# Image, box (left, top, width, height; none: the whole image), truth.
SEEN = [
    ("word01", None, "CHINA"),
    ("word02", None, "HERE"),
    ("word03", None, "riser"),
    ("word04", None, "Produkt"),
    ("segmented_word01", (115, 210, 415, 95), "HOTEL"),
    ("segmented_word02", (48, 222, 390, 90), "Stationery"),
    ("segmented_word04", (70, 272, 515, 105), "FOSTER'S"),
    ("segmented_word05", (170, 42, 335, 95), "SANYO"),
    ("01", (268, 38, 166, 42), "NOTICE"),
    ("06", (320, 285, 136, 34), "galleries"),
]
UNSEEN = [
    ("01", (272, 80, 158, 44), "DOUBLE"),
    ("01", (270, 126, 160, 42), "PARKING"),
    ("01", (270, 170, 160, 40), "PROHIBITED"),
    ("01", (352, 214, 56, 36), "TIMES"),
    ("02", (430, 612, 180, 80), "Sports"),
    ("02", (612, 625, 168, 75), "Centre"),
    ("02", (430, 752, 296, 88), "Conference"),
    ("02", (730, 768, 166, 76), "Centre"),
    ("02", (430, 828, 98, 68), "Car"),
    ("02", (535, 838, 148, 66), "Parks"),
    ("03", (200, 550, 170, 78), "copy"),
    ("03", (400, 540, 222, 70), "centre"),
    ("03", (128, 568, 62, 46), "the"),
    ("04", (418, 416, 64, 44), "GM"),
    ("04", (484, 416, 72, 44), "125"),
    ("05", (475, 318, 55, 62), "NO"),
    ("05", (530, 318, 162, 68), "PARKING"),
    ("05", (90, 172, 36, 42), "NO"),
    ("05", (122, 174, 104, 46), "PARKING"),
    ("06", (238, 283, 80, 34), "priory"),
    ("06", (536, 298, 56, 28), "ship"),
    ("segmented_word02", (438, 222, 158, 84), "Box"),
    ("segmented_word03", (132, 68, 362, 76), "Customer"),
    ("segmented_word03", (116, 150, 396, 90), "Freephone"),
    ("segmented_word03", (98, 238, 254, 76), "Private"),
    ("segmented_word03", (360, 238, 166, 74), "Hire"),
    ("segmented_word03", (164, 326, 292, 84), "Service"),
    ("segmented_word05", (180, 384, 150, 30), "MULTIMEDIA"),
    ("segmented_word05", (330, 384, 146, 30), "PROJECTOR"),
    ("segmented_word05", (178, 322, 164, 62), "PRO"),
]
ROOMS = range(1, 21)  # seeds


def crop(hc, name, box, to):
    """Writes a part of a photograph as a PPM file."""
    photograph = FOLDER / ("scenetext%s%s.jpg" % ("" if name[0].isdigit() else "_", name))
    command = [hc, "camera", photograph, "--count", "1", "--out", "left=-"]
    message = subprocess.run(command, stdout=-1, check=True).stdout
    header, pixels = message.split(b"\n", 1)
    columns, rows = map(int, header.split()[9:11])
    left, top, width, height = box or (0, 0, columns, rows)
    cut = b"".join(
        pixels[3 * (row * columns + left) : 3 * (row * columns + left + width)]
        for row in range(top, top + height)
    )
    pathlib.Path(to).write_bytes(b"P6 %d %d 255\n" % (width, height) + cut)


def edits(truth, read):
    """Letters to insert, delete or replace to make one text of the other (Levenshtein)."""
    row = list(range(len(read) + 1))
    for i, letter in enumerate(truth, 1):
        above, row[0] = row[0], i
        for k, other in enumerate(read, 1):
            above, row[k] = row[k], min(above + (letter != other), row[k] + 1, row[k - 1] + 1)
    return row[-1]


def shell(command, folder):
    return subprocess.run(
        ["bash", "-o", "pipefail", "-c", command], cwd=folder, stdout=-1, check=True, text=True
    ).stdout


def first_text(lines):
    lines = lines.splitlines()
    return json.loads(lines[0])["elements"][0] if lines else ""


def read_word(hc, folder):
    return first_text(
        shell(
            "%s camera word.ppm --count 1 | %s read --upper_case=false --repeat 1 --confidence 0"
            " --in image=- --out text=- | %s cat --json" % (hc, hc, hc),
            folder,
        )
    )


def read_by_tesseract(segmentation, folder):
    return shell("tesseract word.ppm - --psm %d 2>/dev/null" % segmentation, folder).strip()


def read_board(hc, folder, truth, seed, noise):
    shell(
        "rm -f eye && %s send --type rotation 0 -0.04 0.3 --coord 13 >gaze &&"
        " %s simulator --paced=false --count 6 --text '%s' --seed %d --noise %d"
        " --in gaze=gaze --out left=eye" % (hc, hc, truth, seed, noise),
        folder,
    )
    command = "%s read --rate 0 --in image=eye --out text=- | %s cat --json"
    return first_text(shell(command % (hc, hc), folder))


def error_rate(pairs):
    """Of the letters of (truth, what was read) [%]."""
    pairs = list(pairs)
    return 100 * sum(edits(*pair) for pair in pairs) / sum(len(truth) for truth, _ in pairs)


def measure_words(hc, folder):
    readers = {"read": lambda: read_word(hc, folder)}
    if shutil.which("tesseract"):
        for mode in (3, 7, 8):
            readers["tesseract --psm %d" % mode] = lambda mode=mode: read_by_tesseract(mode, folder)
    print("| wrong characters [%%] | %d words seen | %d not seen |" % (len(SEEN), len(UNSEEN)))
    print("|---|---:|---:|")
    for name, read in readers.items():
        rates = []
        for words in (SEEN, UNSEEN):
            pairs = []
            for image, box, truth in words:
                crop(hc, image, box, folder / "word.ppm")
                pairs.append((truth, read()))
            rates.append(error_rate(pairs))
        print("| %s | %.1f | %.1f |" % (name, *rates), flush=True)


def measure_board(hc, folder):
    for noise in (0, 20):
        pairs = []
        for seed in ROOMS:
            draw = random.Random(seed)
            letters = string.ascii_uppercase + string.digits
            truth = "".join(draw.choice(letters) for _ in range(draw.randint(5, 16)))
            pairs.append((truth, read_board(hc, folder, truth, seed, noise)))
        print("board, noise %d: %.1f %% wrong" % (noise, error_rate(pairs)), flush=True)


def main():
    hc = pathlib.Path(sys.argv[1], "bin/hc").resolve()
    with tempfile.TemporaryDirectory() as name:
        measure_words(hc, pathlib.Path(name))
        measure_board(hc, pathlib.Path(name))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main()
