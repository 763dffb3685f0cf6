#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""hc record and play."""

import json
import time
import unittest

from harness import DATA, Pipes


class Recording(Pipes):
    def test_record_and_play_give_the_same_bytes(self):
        self.write_recording()
        self.shell("hc play --speed max r.mtp | hc record copy.mtp")
        self.shell("cmp r.mtp copy.mtp")
        out = self.shell("hc play --speed max --from 0.05 --to 0.1 r.mtp | hc cat --json")
        self.assertEqual([json.loads(line)["seq"] for line in out.splitlines()], [3, 3, 4, 5, 5])
        out = self.shell("hc play --speed max --loop r.mtp | hc cat --json --count 50")
        self.assertEqual(out.count("\n"), 50)

    def test_play_gives_every_message_and_waits_for_no_jump_of_the_clock(self):
        begin, hour, years = 10**18, 3600 * 10**9, 20075 * 86400 * 10**9
        times = (begin, begin - hour, 0, begin + years, begin + 1)
        self.write(
            "r.mtp",
            "".join("1 7 0 %d 8 %d 120190 0 0 1 1\n1\n" % each for each in enumerate(times)),
        )
        self.shell("hc record r.mtp r.mcap")
        for name in ("r.mtp", "r.mcap"):
            out = self.shell("hc play %s | hc cat --json" % name)
            self.assertEqual(
                [json.loads(line)["seq"] for line in out.splitlines()], [0, 1, 2, 3, 4]
            )
            self.assertIn("hc play: skipping a pause of 20075 d (--gap)\n", self.err)

    def test_durations_are_numbers(self):
        self.write_recording()
        for option in (
            "--gap nan",
            "--gap inf",
            "--from nan",
            "--to -1",
            "--speed nan",
            "--speed inf",
        ):
            self.shell("hc play r.mtp " + option, 2)
            self.assertIn(option.split()[0], self.err)
        for command in ("record r.mtp x.mcap --last nan", "trace a.b --duration nan"):
            self.shell("hc " + command, 2)

    def test_names_with_a_colon_are_files_in_every_verb(self):
        name = "2025-11-25T13:00:00.mcap"
        self.shell("hc send 1 | hc record " + name)
        self.assertEqual(self.read_bytes(name)[:5], b"\x89MCAP")
        for verb in ("info", "cat", "play --speed max --out 13:00.mcap", "record 14:00.mtp --in"):
            self.shell("hc %s %s" % (verb, name))
        for name in ("13:00.mcap", "14:00.mtp"):
            self.assertEqual(self.shell("hc cat --json " + name).count("\n"), 1)
        self.shell("hc send 1 | hc record run:1.mcap", 2)
        self.assertIn("run:1.mcap is a link", self.err)
        # The same for a module's own links.
        self.shell("hc send --type rgb_image --scalar u8 1 2 3 | hc record 15:00.mtp")
        self.shell("hc brightness --in 15:00.mtp --out 16:00.mtp")
        self.assertEqual(self.shell("hc cat --json 16:00.mtp").count("\n"), 1)
        self.shell("hc brightness --in 15:00.mtp --out X.MCAP", 2)
        self.assertIn("links do not write MCAP", self.err)
        self.shell("hc brightness --in 15:00.mtp --out 'tcp:x?y'", 2)

    def test_play_keeps_the_time_of_the_recording(self):
        self.write_recording()
        begin = time.monotonic()
        self.shell("hc play r.mtp > /dev/null")
        self.assertGreaterEqual(time.monotonic() - begin, 0.18)
        begin = time.monotonic()
        self.shell("hc play --speed 0.5 r.mtp > /dev/null")
        self.assertGreaterEqual(time.monotonic() - begin, 0.36)

    def test_a_truncated_file_gives_what_is_whole(self):
        self.write_recording()
        whole = self.read_bytes("r.mtp")
        self.write("cut.mtp", whole[:-3])
        out = self.shell("hc cat --json cut.mtp", 1)
        self.assertEqual(out.count("\n"), 18)
        self.assertIn("R2 stream: truncated in message 19, at byte %d" % (len(whole) - 3), self.err)

    def test_skip_continues_after_damage(self):
        self.write_recording()
        whole = self.read("r.mtp").splitlines(True)
        whole[4] = whole[4].replace("10390", "99999")
        self.write("bad.mtp", "".join(whole))
        self.shell("mkdir bad; cp bad.mtp bad/bad.mtp; hc info bad", 1)
        self.assertIn("18 messages", self.shell("hc info --skip bad"))
        out = self.shell("hc cat --json --skip bad.mtp")
        self.assertEqual(out.count("\n"), 18)
        self.assertIn("R20 info", self.err)
        self.assertEqual(self.shell("hc cat --json bad.mtp", 1).count("\n"), 2)

    def test_a_file_that_may_not_grow_is_an_error(self):
        """No program is killed by the signal of the limit."""
        self.write_recording()
        for command in (
            "hc cat --json r.mtp",
            "hc describe camera",
            "hc camera --help",
            "hc camera %s/aloeL.jpg" % DATA,
        ):
            with self.subTest(command):
                self.shell("ulimit -f 1; %s >large" % command, 1)
                self.assertIn("File too large", self.err)

    def test_a_loop_over_nothing_ends(self):
        self.shell(": >empty.mtp; hc play empty.mtp --loop")
        self.write_recording()
        self.shell("hc play r.mtp --loop --from 100")

    def test_record_does_not_empty_what_it_reads(self):
        self.write_recording()
        before = self.read_bytes("r.mtp")
        for command in ("hc record r.mtp --in r.mtp", "hc record ./r.mtp < r.mtp"):
            self.shell(command, 2)
            self.assertIn("is also the output file", self.err)
        self.assertEqual(self.read_bytes("r.mtp"), before)
        self.shell(
            "hc record 'odd?name&=.mtp' --in r.mtp --in r.mtp && hc play --speed max 'odd?name&=.mtp' | hc info"
        )

    def test_record_takes_a_source_as_the_other_verbs_do(self):
        self.write_recording()
        self.shell("hc record r.mtp copy.mtp && cmp r.mtp copy.mtp")
        self.shell("hc record --in r.mtp other.mtp && cmp r.mtp other.mtp")
        self.shell("hc record r.mtp copy.mtp three.mcap")
        self.assertRegex(self.shell("hc info three.mcap"), r"\ncopy +10 .*(\n.*)*\nr +10 ")

    def test_record_does_not_wait_for_messages_from_a_terminal(self):
        # `script` runs a command with a terminal at its standard input.
        self.assertIn(
            "nothing to record to a.b: give a source",
            self.shell("script -qec 'hc record a.b' /dev/null", 2),
        )

    def test_record_names_the_link_that_is_wrong(self):
        self.write_recording()
        self.write("bad.mtp", "rubbish\n")
        self.shell(": >empty.mtp; hc record x.mtp --in empty.mtp --in bad.mtp --in r.mtp", 1)
        self.assertIn("bad.mtp: R5", self.err)


if __name__ == "__main__":
    unittest.main()
