#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""hc itself: exit status, help, errors, closed descriptors, signals."""

import json
import os
import re
import signal
import unittest

from harness import BUILD, DATA, Pipes, ROOT, WATCHDOG, free_port, listens, wait_until


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
                "hc run hed",
                1,
                "hc run: NotFound: hed: cannot be read: No such file or directory, did you mean "
                '"head"?',
            ),
            (
                "hc new module camera",
                2,
                'hc new: Invalid: "camera" is a module of Hypercolumn, which hc and graphs would ',
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
            (
                "hc echo a",
                2,
                'hc: unknown command or module "echo"; to print what a port sends: hc',
            ),
            ("hc topic list", 2, 'hc: unknown command or module "topic"; hc ports lists the ports'),
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
        self.assertRegex(self.err, "hc estop; .*hc graph stop")
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
        os.mkdir(self.path("head"))  # as ./dev run makes it
        self.assertIn("no problems found", self.shell("hc check head"))
        self.shell("hc check depht.toml", 1)
        self.assertIn("depht.toml: cannot be read", self.err)

    def test_help_names_ranges_and_choices(self):
        out = self.shell("hc gaze --help")
        self.assertRegex(out, r"--salience +\S.* \(from 0 to 1; default 0.5\)")

    def test_output_that_fails_is_reported(self):
        self.write_recording()
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

    def test_busy_verbs_can_be_told_to_stop(self):
        self.write_recording()
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
        self.write_recording()
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

    def test_a_repeated_option_takes_one_word_each(self):
        self.assertIn("no problems", self.shell("hc check --set depth.block_size=7 depth"))

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
