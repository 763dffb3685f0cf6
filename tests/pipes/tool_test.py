#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The verbs of hc, and modules as programs."""

import json
import os
import re
import signal
import time
import unittest

from harness import BUILD, DATA, PYTHON, Pipes, ROOT, WATCHDOG, free_port, listens, wait_until


class Tool(Pipes):
    def test_exit_status_and_one_line(self):
        for command, status, line in [
            ("hc cat /nowhere", 1, "hc cat: NotFound: /nowhere: open(/nowhere): No such file"),
            ("hc nonsense", 2, 'hc: unknown command or module "nonsense"; see hc --help'),
            ("hc cat --nonsense", 2, "hc cat: The following argument was not expected: --nonsense"),
            ("hc play", 2, "hc play: file is required"),
            ("hc run missing.toml", 1, "hc run: NotFound: missing.toml: cannot be read: No such"),
            (
                "hc run nosuch",
                1,
                "hc run: NotFound: nosuch: cannot be read: No such file or "
                "directory; shipped graphs: clocked_track, depth, depth_stereo, fleet_camera, ",
            ),
            (
                "hc camera --widht 1",
                2,
                'camera: Invalid: no option "--widht", did you mean "--width"?',
            ),
            (
                "hc send --type positn 1",
                2,
                'hc send: Invalid: no matrix type "positn", did you mean "position"?',
            ),
            (
                "hc send --scalar q 1",
                2,
                'hc send: Invalid: no scalar "q"; there are: u8, i8, u16, ',
            ),
            (
                "hc cat --cuont=1",
                2,
                'hc cat: The following argument was not expected: --cuont=1, did you mean "--count"?',
            ),
            ("hc camera nothing.jpg", 2, "camera: Invalid: nothing.jpg: no such file"),
            (
                "echo rubbish | hc cat",
                1,
                'hc cat: Malformed: -: R5 version: "rubbish" is not an integer',
            ),
            (
                "hc send --type position 1 2",
                2,
                "hc send: Invalid: 2 numbers do not make elements of 3",
            ),
            ("hc camra", 2, 'hc: unknown command or module "camra", did you mean "camera"?'),
            (
                "hc rnu",
                2,
                'hc: unknown command or module "rnu", did you mean "run"?; see hc --help',
            ),
            ("hc describe camra", 1, 'hc describe: NotFound: no program "camra", did you mean'),
            ("touch gauge; hc ./gauge", 2, "hc: ./gauge is not executable"),
            ("hc describe ./gauge", 1, "hc describe: NotFound: ./gauge is not executable"),
            ("hc ./none", 2, 'hc: no program "./none"'),
            ("hc ./", 2, "hc: ./ is a folder, not a program"),
            ("hc send", 2, "hc send: Invalid: nothing to send"),
            ("hc send --text a 1", 2, "hc send: Invalid: --text and numbers exclude each other"),
            (
                "hc send --text a --width 1",
                2,
                "hc send: Invalid: --scalar, --components and --width",
            ),
            ("hc send --coord head 1", 2, 'hc send: --coord: "head" is not a whole number'),
            ("hc cat --count -1", 2, 'hc cat: --count: "-1" is not a whole number'),
            ("hc cat inproc:x", 2, "hc cat: Invalid: inproc:x: inproc links threads"),
            (
                "DISPLAY=:9797 hc view --window yes",
                1,
                "view: window: no display",
            ),
            ("hc send --type position 1 2 x", 1, 'hc send: Malformed: elements: R27: "x" is not'),
        ]:
            with self.subTest(command):
                self.shell(command, status)
                self.assertTrue(self.err.startswith(line), self.err)
                self.assertEqual(self.err.count("\n"), 1, self.err)

    def test_a_peer_that_never_was_there_is_named(self):
        uri = "tcp:%d?reconnect=1" % free_port()
        for command, who in (
            ("hc cat '%s'", "hc cat"),
            ("hc send 1 --out '%s'", "hc send"),
            ("hc brightness --in '%s'", "brightness"),
            ("hc camera %s/aloeL.jpg --out '%%s'" % DATA, "camera"),
        ):
            with self.subTest(command):
                self.shell(command % uri, 1)
                line = "%s: NotFound: %s: no peer for 1 s: Connection refused\n" % (
                    who,
                    uri,
                )
                self.assertEqual(self.err, line)

    def test_version_commit_and_features(self):
        cmake = (ROOT / "CMakeLists.txt").read_text()
        version = re.search(r"VERSION ([\d.]+) LANG", cmake)[1]
        self.assertIn("\nversion: %s\n" % version, (ROOT / "CITATION.cff").read_text())
        self.assertIn("\n## %s (" % version, (ROOT / "CHANGELOG.md").read_text())
        first, *features = self.shell("hc --version").splitlines()
        self.assertRegex(first, r"^hc %s, commit ([0-9a-f]{12}(-modified)?|unknown)$" % version)
        self.assertRegex(
            features[0], r"^features:( zstd)?( jpeg)?( tls)?( dds)?( python)?( head)?$"
        )
        said = " ".join(features).replace("features:", "").replace("not built:", "").split()
        self.assertEqual(sorted(said), sorted("zstd jpeg tls dds python head".split()))

    def test_features_are_those_that_work(self):
        features = set(self.shell("hc --version").splitlines()[1].split()[1:])
        self.shell("hc cat pigeon:x", 2)
        works = set(re.findall(r"\b(?:tls|dds)\b(?!-)", self.err))
        self.shell("hc send --encoding zstd 1 || true")
        works |= set() if "Unsupported" in self.err else {"zstd"}
        self.shell("hc send --encoding jpeg --type intensity_image --scalar u8 1 || true")
        works |= set() if "Unsupported" in self.err else {"jpeg"}
        works |= {"python"} if list(BUILD.glob("python/hypercolumn/_hypercolumn*.so")) else set()
        works |= {"head"} if (BUILD / "libexec/hypercolumn/camera").exists() else set()
        self.assertEqual(features, works)

    def test_help_lists_all_links(self):
        self.assertIn("shm:NAME", self.shell("hc --help"))

    def test_help_has_columns(self):
        lines = self.shell("hc camera --help").splitlines()
        for option in ("  --modes NUMBER,…", "  --mode NUMBER", "  --name NAME"):
            line = next(line for line in lines if line.startswith(option + " "))
            self.assertRegex(line, r"^.{27} [a-z]")

    def test_an_included_file_is_named_by_where_it_was_looked_for(self):
        self.write("g.toml", 'version = 1\n[graphs.a]\nfile = "none.toml"\n')
        self.shell("hc check g.toml", 2)
        self.assertIn(
            "g.toml:3: %s: cannot be read: No such file or directory\n"
            % os.path.realpath(self.path("none.toml")),
            self.err,
        )

    def test_a_program_that_is_no_module_is_led_to_the_specification(self):
        for program in ("/bin/cat", "/bin/echo"):
            self.write("g.toml", 'version = 1\n[modules.a]\nprogram = "%s"\n' % program)
            self.shell("hc check g.toml", 2)
            self.assertIn("spec/module.md", self.err)

    def test_hc_alone_gives_an_overview(self):
        out = self.shell("hc", 2)
        self.assertLess(out.count("\n"), 15)
        self.assertIn("hc run graphs/depth.toml", out)

    def test_shells_and_man_know_the_commands(self):
        self.shell("hc completion >completion")
        complete = "source completion; COMP_WORDS=(%s) COMP_CWORD=%d; _hc; echo ${COMPREPLY[*]}"
        self.assertEqual(self.shell("hc completion bash | cmp - completion"), "")
        self.assertEqual(self.shell(complete % ("hc reco", 1)).split(), ["record", "recorder"])
        self.assertIn("brightness", self.shell(complete % ("hc br", 1)).split())
        self.assertEqual(self.shell(complete % ("hc cat --js", 2)).split(), ["--json"])
        self.assertIn("unlink", self.shell(complete % ("hc graph unl", 2)).split())
        page = self.shell("hc man >hc.1; man -l hc.1 2>/dev/null || cat hc.1")
        for word in ("record", "MODULE.PORT", "HC_GRAPH"):
            self.assertIn(word, page)
        page = self.read("hc.1")
        self.assertIn("\n.B \\-\\-count\nend after this many messages", page)
        self.assertNotRegex(page, r"\n\.B *\n")
        self.assertRegex(self.shell("hc --help"), r"\n  completion +Print[^\n]*\n  man +Print")
        self.assertNotIn("\n  complete ", self.shell("hc --help"))

    def test_words_of_other_programs_lead_to_ours(self):
        self.assertEqual(self.shell("hc help"), self.shell("hc --help"))
        self.assertEqual(self.shell("hc help ps"), self.shell("hc ps --help"))
        self.shell("hc stop", 2)
        self.assertIn("hc graph stop", self.err)
        self.shell("hc list", 2)
        self.assertIn("hc ports", self.err)

    def test_shipped_graphs_are_found_by_name(self):
        for name in ("depth", "depth.toml"):
            self.assertIn("no problems found", self.shell("hc check " + name))
        self.write("mine.toml", 'version = 1\n[graphs.own]\nfile = "depth.toml"\n')
        self.assertIn("no problems found", self.shell("hc check mine.toml"))
        self.write("depth.toml", "version = 1\n[modules.none]\n")  # the nearer one
        self.shell("hc check mine.toml", 2)
        self.assertIn("depth.toml:2: ", self.err)
        self.shell("hc check depht.toml", 1)
        self.assertIn("depht.toml: cannot be read", self.err)

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

    def test_help_names_ranges_and_choices(self):
        out = self.shell("hc gaze --help")
        self.assertRegex(out, r"--salience +\S.* \(from 0 to 1; default 0.5\)")

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

    def record(self):
        """Ten positions, 20 ms apart, of two senders; one lost."""
        lines = []
        for i in range(10):
            lines.append(
                "1 7 0 %d 8 %d 10390 0 3 1 1\n%d 0 0\n" % (i, 10**18 + i * 20_000_000, i)
            )
            if i != 4:
                lines.append(
                    "1 8 0 %d 8 %d 120190 0 0 1 1\n%d\n" % (i, 10**18 + i * 20_000_000, i)
                )
        self.write("r.mtp", "".join(lines))

    def test_info_tells_rates_gaps_and_sizes(self):
        self.record()
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
        self.shell(image + "hc view --save kept.mtp", 1)
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

    def test_record_and_play_give_the_same_bytes(self):
        self.record()
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

    def test_play_keeps_the_time_of_the_recording(self):
        self.record()
        begin = time.monotonic()
        self.shell("hc play r.mtp > /dev/null")
        self.assertGreaterEqual(time.monotonic() - begin, 0.18)
        begin = time.monotonic()
        self.shell("hc play --speed 0.5 r.mtp > /dev/null")
        self.assertGreaterEqual(time.monotonic() - begin, 0.36)

    def test_a_truncated_file_gives_what_is_whole(self):
        self.record()
        whole = self.read_bytes("r.mtp")
        self.write("cut.mtp", whole[:-3])
        out = self.shell("hc cat --json cut.mtp", 1)
        self.assertEqual(out.count("\n"), 18)
        self.assertIn(
            "R2 stream: truncated after 18 messages, at byte %d" % (len(whole) - 3), self.err
        )

    def test_skip_continues_after_damage(self):
        self.record()
        whole = self.read("r.mtp").splitlines(True)
        whole[4] = whole[4].replace("10390", "99999")
        self.write("bad.mtp", "".join(whole))
        self.shell("mkdir bad; cp bad.mtp bad/bad.mtp; hc info bad", 1)
        self.assertIn("18 messages", self.shell("hc info --skip bad"))
        out = self.shell("hc cat --json --skip bad.mtp")
        self.assertEqual(out.count("\n"), 18)
        self.assertIn("R20 info", self.err)
        self.assertEqual(self.shell("hc cat --json bad.mtp", 1).count("\n"), 2)

    def test_output_that_fails_is_reported(self):
        self.record()
        for command in (
            "hc cat r.mtp >/dev/full",
            "hc cat --raw --skip r.mtp >/dev/full",
            "hc info r.mtp >/dev/full",
            "hc camera --help >/dev/full",
            "hc describe brightness >/dev/full",
        ):
            with self.subTest(command):
                self.shell(command, 1)
                self.assertIn("No space left on device", self.err)

    def test_a_file_that_may_not_grow_is_an_error(self):
        """No program is killed by the signal of the limit."""
        self.record()
        for command in (
            "hc cat --json r.mtp",
            "hc describe camera",
            "hc camera --help",
            "hc camera %s/aloeL.jpg" % DATA,
        ):
            with self.subTest(command):
                self.shell("ulimit -f 1; %s >large" % command, 1)
                self.assertIn("File too large", self.err)

    def test_busy_verbs_can_be_told_to_stop(self):
        self.record()
        for command in (
            "hc play r.mtp --loop --speed max >/dev/null",
            "hc play r.mtp --loop --speed max --out tcp-listen:%d" % free_port(),
            "hc cat /dev/zero --skip --limit 10",
        ):
            with self.subTest(command):
                process = self.start("exec " + command)
                wait_until(lambda: self.catches_term(process.pid))
                os.kill(process.pid, signal.SIGTERM)
                process.communicate(timeout=WATCHDOG)
                self.assertIn(process.returncode, (0, 1))

    def test_closed_descriptors_take_nothing(self):
        self.record()
        self.shell("hc info <&-; hc cat --json r.mtp >&-")
        for closed in ("<&-", "<&- 2>&-", "<&- >&- 2>&-"):
            with self.subTest(closed):
                # A warning goes to no file that is opened in the place of a descriptor.
                self.shell("rm -f out.mtp; hc record r.mtp out.mtp --count 3 %s" % closed)
                self.assertEqual(self.shell("hc cat --json out.mtp").count("\n"), 3)
                self.shell(
                    "rm -f out.mtp; hc camera nothing.png --out left=file:out.mtp " + closed, 2
                )
                self.assertFalse(os.path.exists(self.path("out.mtp")) and self.read("out.mtp"))

    def test_a_loop_over_nothing_ends(self):
        self.shell(": >empty.mtp; hc play empty.mtp --loop")
        self.record()
        self.shell("hc play r.mtp --loop --from 100")

    def test_record_does_not_empty_what_it_reads(self):
        self.record()
        before = self.read_bytes("r.mtp")
        for command in ("hc record r.mtp --in r.mtp", "hc record ./r.mtp < r.mtp"):
            self.shell(command, 2)
            self.assertIn("is also the output file", self.err)
        self.assertEqual(self.read_bytes("r.mtp"), before)
        self.shell(
            "hc record 'odd?name&=.mtp' --in r.mtp --in r.mtp && hc play --speed max 'odd?name&=.mtp' | hc info"
        )

    def test_record_takes_a_source_as_the_other_verbs_do(self):
        self.record()
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

    def test_a_repeated_option_takes_one_word_each(self):
        self.assertIn("no problems", self.shell("hc check --set depth.block_size=7 depth"))

    def test_record_names_the_link_that_is_wrong(self):
        self.record()
        self.write("bad.mtp", "rubbish\n")
        self.shell(": >empty.mtp; hc record x.mtp --in empty.mtp --in bad.mtp --in r.mtp", 1)
        self.assertIn("bad.mtp: R5", self.err)

    def test_an_image_gets_the_header_that_was_asked_for(self):
        out = self.shell(
            "hc send --image %s/aloeL.jpg --src 3 --dst 5 --seq 9 --ttl 2 --time 5 --mode 4 --coord 8"
            " | hc cat --raw | head -n 1" % DATA
        )
        self.assertEqual(out, "1 3 5 9 2 5 30301 4 8 1282 1110\n")
        self.shell("hc send --image none.jpg", 1)
        self.assertEqual(self.err.count("\n"), 1)

    def test_hostile_messages_end_with_one_line(self):
        head = "1 7 0 0 8 0 "
        for line, got in [
            (head + "30301 1 7 9223372036854775808 1", "R15 width"),
            (head + "30301 1 7 -1 1", "R15 width"),
            (head + "30301 1 7 2147483647 2147483647", "R24 width"),
            (head + "30301 1 7 1", "R4 height"),
            (head + "30301 1 7 1 1 1", "R4 header"),
            (head + "9" * 10000, "R3 header"),
            (head + "0x7 1 7 1 1", "R5 info"),
            (head + "30301 1 7 1\0 1", "R5 width"),
            (head + "40102 1 7 16000 16000\n22\n" + "x" * 22, "R36 elements"),
        ]:
            with self.subTest(got):
                self.shell("hc cat", 1, line.encode() + b"\n")
                self.assertRegex(self.err, r"^hc cat: [A-Za-z]+: -: %s: .*, at byte \d+\n$" % got)
        self.shell("head -c 1000000000 /dev/zero | tr '\\0' 1 | hc cat; exit ${PIPESTATUS[2]}", 1)
        self.assertIn("R3 header", self.err)

    def test_orders_that_are_wrong_end_an_agent_with_one_line(self):
        for order in (
            '{"what":"find","subject":5}',
            '{"what":"find","id":"x","subject":"camera"}',
            '{"what":"hold"}',
            '{"what":"start","number":{}}',
        ):
            text = "1 1 0 0 8 0 60100 0 0 %d 1\n%s\n" % (len(order), order)
            self.shell("hc agent >answers", 1, text.encode())
            self.assertRegex(self.err, r"^hc agent: Malformed: order: .*\n$")

    def test_describe_is_json(self):
        for module in ("camera", "depth", "view", "brightness", "depth_score"):
            got = json.loads(self.shell("hc describe " + module))
            self.assertEqual(got["name"], module)
            self.assertIn(got["summary"], self.shell("hc %s --help" % module))

    def test_interrupt_ends_a_verb_cleanly(self):
        port = free_port()
        for command in ("hc cat tcp-listen:%d" % port, "hc record x.mtp --in tcp-listen:%d" % port):
            process = self.start("exec " + command)
            wait_until(lambda: listens(port))
            os.kill(process.pid, signal.SIGINT)
            process.communicate(timeout=WATCHDOG)
            self.assertEqual(process.returncode, 0, command)


if __name__ == "__main__":
    unittest.main()
