#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Other programs as peers: netcat, telnet, awk, head, NumPy, gnuplot, Octave."""

import json
import unittest

from harness import DATA, PYTHON, Pipes, ROOT, WATCHDOG, free_port, listens, wait_until


class Programs(Pipes):
    def test_a_person_types_a_position_into_netcat(self):
        port = free_port()
        cat = self.start("hc cat --count 1 tcp-listen:%d" % port)
        wait_until(lambda: listens(port))
        self.shell("nc -N localhost %d" % port, data=b"1 7 0 1 8 0 10390 1 3 1 1\n0.1 0.2 0.3\n")
        out, _ = cat.communicate(timeout=WATCHDOG)
        self.assertEqual(
            out.decode(), "position 1 x 1 of 3 x f64, src 7 seq 1 mode 1 in head\n  0.1 0.2 0.3\n"
        )

    def test_telnet_line_ends_are_taken(self):
        out = self.shell("hc cat --json", data=b"1 7 0 1 8 0 10390 1 3 1 1 \r\n0.1 0.2 0.3\r\n")
        self.assertEqual(json.loads(out)["elements"], [[[0.1, 0.2, 0.3]]])

    def test_head_shows_a_readable_header(self):
        out = self.shell("hc camera %s/aloeL.jpg | head -c 60 | head -n 1; true" % DATA)
        self.assertRegex(out, r"^1 1 0 0 8 [0-9]{19} 30301 0 7 1282 1110$")

    def test_a_line_of_awk_is_a_module(self):
        awk = "awk 'NR % 2 { print; next } { print $1 * 10, $2, $3 }'"
        out = self.shell("hc send --type position --src 7 0.1 0.2 0.3 | %s | hc cat --json" % awk)
        self.assertEqual(json.loads(out)["elements"], [[[1, 0.2, 0.3]]])

    def test_brightness_in_awk_is_brightness_in_cpp(self):
        camera = "hc camera %s/aloeL.jpg --width 80 --height 60" % DATA
        awk = "awk -f %s/modules/brightness/brightness.awk" % ROOT
        ours = json.loads(self.shell(camera + " | hc brightness | hc cat --json"))
        theirs = json.loads(self.shell("%s --encoding text | %s | hc cat --json" % (camera, awk)))
        self.assertEqual(ours["elements"], theirs["elements"])
        self.assertGreater(ours["elements"][0][0], 50)
        self.assertNotEqual(ours["time"], 0)

    def send_table(self):
        self.shell("hc send --width 3 1 2.5 -3 4e-7 nan 6 > table.mtp")

    def test_numpy_reads_text_elements(self):
        self.send_table()
        out = self.shell(
            PYTHON + ' -c \'import numpy; m = numpy.loadtxt("table.mtp", skiprows=1);'
            "print(m.shape, m[0, 1], m[1, 0], m[1, 1])'"
        )
        self.assertEqual(out, "(2, 3) 2.5 4e-07 nan\n")

    def test_octave_reads_text_elements(self):
        self.send_table()
        octave = (
            "m = dlmread('table.mtp', ' ', 1, 0); printf('%d %d %g %g\\n', size(m), m(1,2), m(2,3))"
        )
        out = self.shell('octave-cli --no-init-file --quiet --eval "%s"' % octave)
        self.assertEqual(out, "2 3 2.5 6\n")

    def test_gnuplot_reads_text_elements(self):
        self.shell("hc send --type position 0 0 1 1 10 2 2 20 3 --width 1 > path.mtp")
        out = self.shell(
            "gnuplot -e \"stats 'path.mtp' skip 1 using 2 nooutput; print STATS_max, STATS_records\" 2>&1"
        )
        self.assertEqual(out.split(), ["20.0", "3"])

    def test_a_file_a_pipe_and_tee_are_peers(self):
        out = self.shell("hc send --text hello | tee copy.mtp | hc cat; cat copy.mtp | hc cat")
        self.assertEqual(out.count("  hello\n"), 2)


if __name__ == "__main__":
    unittest.main()
