#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""hc send, cat, info and view."""

import json
import os
import unittest

from harness import DATA, PYTHON, Pipes


class Messages(Pipes):
    def test_send_makes_what_it_is_asked_for(self):
        out = self.shell(
            "hc send --src 3 --dst -1 --seq 9 --ttl 2 --time 5 --mode 4 --coord 1003 --encoding zstd"
            " --type transformation --scalar f32 --width 2 1 0 0 1 | hc cat --json"
        )
        got = json.loads(out)
        for key, value in dict(
            src=3, dst=-1, seq=9, ttl=2, time=5, mode=4, coord=1003, width=2, height=2
        ).items():
            self.assertEqual(got[key], value)
        self.assertEqual((got["encoding"], got["scalar"]), ("zstd", "f32"))
        self.assertEqual(got["elements"], [[1, 0], [0, 1]])

    def test_cat_prints_each_row_of_a_text_on_its_own_line(self):
        self.write("t.mtp", "1 7 0 0 8 0 60100 0 30 5 2\nhelloyou  \n")
        lines = self.shell("hc cat t.mtp").splitlines()
        self.assertEqual(lines[1:], ["  hello", "  you"])

    def test_send_takes_images_and_arrays(self):
        self.shell(
            PYTHON
            + ' -c \'import numpy; numpy.save("a.npy", numpy.arange(6, dtype="<f4").reshape(2, 3))\''
        )
        out = json.loads(self.shell("hc send --npy a.npy --type intensity_image | hc cat --json"))
        self.assertEqual(out["type"], "intensity_image")
        out = json.loads(self.shell("hc send --npy a.npy | hc cat --json"))
        self.assertEqual((out["type"], out["elements"]), ("table", [[0, 1, 2], [3, 4, 5]]))
        out = self.shell("hc send --image %s/aloeL.jpg --src 4 --encoding jpeg | hc info" % DATA)
        self.assertIn("rgb_image 1282 x 1110 of 3 x u8, jpeg", out)

    def test_info_tells_rates_gaps_and_sizes(self):
        self.write_recording()
        out = self.shell("hc info r.mtp")
        self.assertRegex(
            out, r" 7 +10 +240 B +0\.180 s +50 Hz +0 +0  position 1 x 1 of 3 x f64, text"
        )
        self.assertRegex(
            out, r" 8 +9 +72 B +0\.180 s +44\.4 Hz +1 +0  table 1 x 1 of 1 x f64, text"
        )
        self.assertIn("19 messages", out)
        self.assertIn("\n3 messages", self.shell("hc info r.mtp --count 3"))
        self.shell("cat r.mtp r.mtp >twice.mtp")
        self.assertIn(" seq restarted 1 time\n", self.shell("hc info twice.mtp"))

    def test_view_ends_after_so_many_images(self):
        images = "%s/aloeL.jpg --loop --width 8 --height 6" % DATA
        self.shell("hc camera %s | hc view --save all/ --count 2" % images)
        self.assertEqual(len(os.listdir(self.path("all"))), 2)

    def test_view_saves_in_the_place_of_no_recording(self):
        image = "hc camera %s/aloeL.jpg --count 1 --width 8 --height 6 | " % DATA
        self.shell("hc send 1 > kept.mtp")
        self.shell(image + "hc view --save kept.mtp", 2)
        self.assertIn("save: kept.mtp is neither a .png nor a folder/", self.err)
        self.shell(image + "hc view kept.mtp", 2)
        self.assertIn('one argument too many: "kept.mtp"', self.err)
        self.assertRegex(self.shell("hc cat kept.mtp"), "^table ")

    def test_a_stream_of_a_folder_has_the_rate_of_its_own_time(self):
        os.mkdir(self.path("both"))
        for name, count, period in (("fast", 21, 50), ("long", 3, 2000)):  # [ms]
            with open(self.path("both/%s.mtp" % name), "w", encoding="ascii") as file:
                for i in range(count):
                    time = 10**18 + i * period * 10**6
                    file.write("1 1 0 %d 8 %d 120190 0 0 1 1\n%d\n" % (i, time, i))
        out = self.shell("hc info both")
        self.assertRegex(out, r"\nfast +21 +20 Hz ")
        self.assertRegex(out, r"\nlong +3 +0\.5 Hz ")

    def test_an_image_gets_the_header_that_was_asked_for(self):
        out = self.shell(
            "hc send --image %s/aloeL.jpg --src 3 --dst 5 --seq 9 --ttl 2 --time 5 --mode 4 --coord 8"
            " | hc cat --raw | head -n 1" % DATA
        )
        self.assertEqual(out, "1 3 5 9 2 5 30301 4 8 1282 1110\n")
        self.shell("hc send --image none.jpg", 1)
        self.assertEqual(self.err.count("\n"), 1)


if __name__ == "__main__":
    unittest.main()
