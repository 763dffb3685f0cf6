#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The example modules do what they say, and the notebook runs from its first cell to its last."""

import json
import os
import unittest

import numpy

from package import Package, ROOT, hc

from harness import DATA

EXAMPLES = ROOT / "python/examples"


def strings(rows):
    """Messages of text at times: [(time, text)] as bytes."""
    return b"".join(
        b"1 1 0 %d 8 %d 60100 0 0 %d 1\n%s\n" % (i, time, len(text), text)
        for i, (time, text) in enumerate(rows)
    )


class Examples(Package):
    def setUp(self):
        super().setUp()
        self.environment["EXAMPLES"] = str(EXAMPLES)

    def test_edges(self):
        import cv2

        self.shell(
            "hc camera %s/aloeL.jpg --width 320 --height 240 >image.mtp;"
            "$EXAMPLES/edges --low 20 <image.mtp >edges.mtp" % DATA
        )
        (image,), (edges,) = hc.read(self.path("image.mtp")), hc.read(self.path("edges.mtp"))
        grey = cv2.cvtColor(image.matrix, cv2.COLOR_RGB2GRAY)
        self.assertTrue((edges.matrix == cv2.Canny(grey, 20, 150)).all())
        self.assertGreater(edges.matrix.mean(), 1)
        self.assertEqual(edges.time, image.time)

    def test_classify(self):
        rng = numpy.random.default_rng(3)
        colours = {"red": (200, 40, 40), "green": (40, 200, 40), "blue": (40, 40, 200)}
        images, truths, wanted = b"", [], []
        for i in range(30):
            name = list(colours)[i % 3] if i < 12 else rng.choice(list(colours))
            pixels = numpy.clip(rng.normal(colours[name], 30, (30, 40, 3)), 0, 255)
            header = b"1 1 0 %d 8 %d 30301 0 0 40 30\n" % (i, 10 * (i + 1))
            images += header + pixels.astype(numpy.uint8).tobytes() + b"\n"
            if i < 12:
                truths.append((10 * (i + 1) + 5, name.encode()))
            else:
                wanted.append(str(name))
        self.write("images", images)
        self.write("truths", strings(truths))
        self.shell(
            "$EXAMPLES/classify --clock messages --in image=images --in truth=truths"
            " --out label=labels --out scores=scores"
        )
        labels = [message.text for message in hc.read(self.path("labels"))]
        self.assertEqual(labels[-len(wanted) :], wanted)
        for message in hc.read(self.path("scores")):
            self.assertAlmostEqual(sum(message.numbers), 1)

    def test_steer(self):
        step = 10**8  # ns
        rows = [(500, 300), (500, 200), (9000, 300)]
        data = b"".join(
            b"1 1 0 %d 8 %d 10390 0 0 1 1\n%d %d 0\n" % (i, (i + 10) * step, u, v)
            for i, (u, v) in enumerate(rows)
        )
        data += b"1 1 0 4 8 %d 10390 0 0 1 1\n400 300 0\n" % (20 * step)
        out = self.shell("$EXAMPLES/steer --clock messages", data=data)
        self.assertEqual(
            [[float(word) for word in line.split()] for line in out.splitlines()[1::2]],
            [[0, 0, -0.4], [0, -0.4, -0.4], [0, 0, -1], [0, 0, 0], [0, 0, 0]],
        )
        times = [int(line.split()[5]) for line in out.splitlines()[::2]]
        self.assertEqual(times[3], 14 * step)  # it stops 0.2 s after the last target

    def test_steer_removes_a_steady_error(self):
        text = b"1 1 0 %d 8 %d 10390 0 0 1 1\n500 300 0\n"
        data = b"".join(text % (i, 10**9 + i * 10**7) for i in range(50))
        out = self.shell("$EXAMPLES/steer --clock messages --reset 2", data=data)
        speeds = [float(line.split()[2]) for line in out.splitlines()[1::2]]
        self.assertAlmostEqual(speeds[0], -0.4)
        self.assertAlmostEqual(speeds[-1], -0.4 * (1 + 2 * 0.49))

    def test_the_notebook_runs(self):
        cells = json.loads((EXAMPLES / "notebook.ipynb").read_text())["cells"]
        names = {}
        os.environ["PATH"], path = self.environment["PATH"], os.environ["PATH"]
        self.addCleanup(os.environ.__setitem__, "PATH", path)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder.name)
        os.environ["HC_DATA"] = DATA
        shown = []
        for cell in cells:
            if cell["cell_type"] != "code":
                continue
            *lines, last = "".join(cell["source"]).rstrip("\n").split("\n")
            try:
                code = compile(last, "cell", "eval")
            except SyntaxError:
                lines.append(last)
                code = None
            exec(compile("\n".join(lines), "cell", "exec"), names)
            shown.append(eval(code, names) if code else None)
        self.assertIn({"camera": "running", "brightness": "running"}, shown)
        images = [each for each in shown if isinstance(each, hc.Message)]
        self.assertTrue(images[0]._repr_png_().startswith(b"\x89PNG"))
        self.assertEqual(shown[-2], 10)


if __name__ == "__main__":
    unittest.main()
