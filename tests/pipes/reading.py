# SPDX-License-Identifier: Apache-2.0
"""How well the module read reads the simulator's board: a table over seeds, noises and texts.

    python3 tests/pipes/reading.py BUILD_FOLDER [--seeds 20] [--noise 0 2 20]
"""

import argparse
import json
import os
import pathlib
import random
import subprocess
import tempfile

ROOM_TIME = 10**18  # of the first image [ns]; any time will do, and so it is the same each time
LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
WATCHDOG = 100  # [s]


def random_text(seed):
    """Letters and digits, 5 to 16 with a space in some, as on the board of a seed."""
    draw = random.Random(seed)
    length = draw.randint(5, 16)
    text = [draw.choice(LETTERS) for _ in range(length)]
    if length > 8 and draw.random() < 0.5:
        text[draw.randint(3, length - 4)] = " "
    return "".join(text)


def edits(truth, read):
    """Letters to insert, delete or replace to make one text of the other (Levenshtein)."""
    row = list(range(len(read) + 1))
    for i, letter in enumerate(truth, 1):
        above, row[0] = row[0], i
        for k, other in enumerate(read, 1):
            above, row[k] = row[k], min(above + (letter != other), row[k] + 1, row[k - 1] + 1)
    return row[-1]


def read_board(build, text, seed, noise, images=4, options=""):
    """What is read in so many images of the board: the texts given, confidences and targets."""
    with tempfile.TemporaryDirectory() as folder:
        environment = dict(os.environ, PATH="%s/bin:%s" % (build, os.environ["PATH"]))

        def shell(command):
            done = subprocess.run(
                ["bash", "-o", "pipefail", "-ec", command],
                cwd=folder,
                env=environment,
                timeout=WATCHDOG,
                stdout=subprocess.PIPE,
                check=True,
            )
            return done.stdout.decode()

        shell("hc send --type rotation 0 -0.04 0.3 --coord 13 --time %d >gaze.mtp" % ROOM_TIME)
        shell(
            "hc simulator --paced=false --count %d --start %d --text '%s' --seed %d --noise %g"
            " --in gaze=gaze.mtp --out left=eye.mtp" % (images, ROOM_TIME, text, seed, noise)
        )
        shell(
            "hc read --rate 0 %s --in image=eye.mtp --out text=text.mtp"
            " --out confidence=sure.mtp --out target=target.mtp" % options
        )
        found = {}
        for name in ("text", "sure", "target"):
            lines = shell("hc cat --json %s.mtp" % name).splitlines()
            found[name] = [json.loads(line)["elements"] for line in lines]
    found["text"] = [each[0] for each in found["text"]]
    found["sure"] = [each[0][0] for each in found["sure"]]
    found["target"] = [each[0][0] for each in found["target"]]
    return found


def score(build, seeds, noise, out=None, options=""):
    """Character error rate of the first text that is given, over many seeds."""
    wrong = letters = 0
    for seed in seeds:
        truth = random_text(seed)
        found = read_board(build, truth, seed, noise, images=6, options=options)
        read = found["text"][0] if found["text"] else ""
        errors = edits(truth, read)
        wrong += errors
        letters += len(truth)
        if out:
            sure = max(found["sure"], default=0)
            mark = "" if errors == 0 else "   %d wrong" % errors
            out("%5g %4d  %-16s  %-16s  %4.2f%s" % (noise, seed, truth, read, sure, mark))
    return wrong / letters


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--noise", type=float, nargs="+", default=[0, 2, 20])
    parser.add_argument("--options", default="", help="of hc read")
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    print("noise seed  on the board      read              sure")
    rates = {}
    for noise in arguments.noise:
        seeds = range(1, arguments.seeds + 1)
        rates[noise] = score(
            build, seeds, noise, lambda line: print(line, flush=True), arguments.options
        )
    for noise, rate in rates.items():
        print("noise %g: character error rate %.2f %%" % (noise, 100 * rate))


if __name__ == "__main__":
    main()
