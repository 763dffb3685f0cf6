#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Graphs over several hosts, each a network namespace with an sshd of its own. Needs root.

    hosts_test.py BUILD_FOLDER [TEST …]

HC_FULL=1 holds all to the times that doc/hosts.md promises.
"""

import os
import pathlib
import re
import signal
import subprocess
import unittest

from hosts import BRIGHTNESS, BUILD, CAMERA, HC, HostsTest, ROOT, WATCHDOG
from recordings import read_messages

# Begins an expression for sed, in quotes, that replaces the version that an agent tells.
VERSION = '\'s/"version":"[^"]*"/"version":'
# What one module sends passes both hosts, there and back.
DELAYS = """
[modules.source]
program = "{0}/bidder"
parameters = {{ script = "0:1 2:end", rate = 5 }}
[modules.one]
program = "{0}/delay"
host = "h1"
inputs.in = "source.command"
[modules.two]
program = "{0}/delay"
host = "h2"
inputs.in = "one.out"
[modules.three]
program = "{0}/delay"
host = "h1"
inputs.in = "two.out"
[modules.four]
program = "{0}/delay"
inputs.in = "three.out"
""".format(
    BUILD / "tests/programs"
)


class Hosts(HostsTest):
    # What one sees.

    def test_a_graph_over_two_hosts(self):
        (host,) = self.network.add()
        self.write_graph(self.tables(host) + CAMERA % "h1" + BRIGHTNESS % "")
        self.assertIn("no problems found", self.shell("hc check g.toml"))
        process = self.run_graph()
        messages = self.observe(process)
        state = self.flows(messages)
        self.assertEqual(state["links"][0]["transport"], "tls")
        self.assertEqual([each["name"] for each in state["hosts"]], ["h1"])
        camera = self.module(state, "camera")
        self.assertEqual((camera["host"], camera["status"]), ("h1", "running"))
        state = self.state(messages, lambda state: self.module(state, "camera")["memory"] > 0)
        self.assertEqual(self.modules_of(host)["camera"], self.module(state, "camera")["pid"])
        self.assertEqual(self.modules_of(host).keys(), {"camera"})
        # As on one host: set, restart, look, read, record.
        self.assertEqual(self.ask(process, "set camera.rate=20"), ["ok"])
        self.state(
            messages, lambda state: self.module(state, "camera")["parameters"]["rate"] == "20"
        )
        self.assertEqual(self.ask(process, "restart camera"), ["ok"])
        self.await_lines(process, "camera: started")
        state = self.flows(messages, state["links"][0]["messages"])
        self.assertEqual(len(self.shell("hc cat camera.left --count 3 --raw").encode()) > 3 * 80, 1)
        self.assertEqual(self.shell("hc cat camera.left --count 2").count("rgb_image"), 2)
        self.assertIn("h1", self.shell("hc top --once"))
        self.assertEqual(
            self.ask(process, "add more@h1 brightness", "link camera.left more.image rate=10"),
            ["ok"],
        )
        state = self.state(messages, lambda state: self.rate(state, "camera.left", "more.image"))
        self.assertEqual(self.link(state, "camera.left", "more.image")["transport"], "shm")
        self.assertEqual(self.ask(process, "remove more"), ["ok"])
        self.stop(process)
        self.assert_empty(host)

    def test_a_host_that_is_off_at_the_start_is_waited_for(self):
        (host,) = self.network.add()
        self.write_graph(self.tables(host) + CAMERA % "h1" + BRIGHTNESS % "")
        host.cut()
        process = self.start("exec hc run g.toml")
        self.await_lines(process, "g.toml:2: host h1: ssh: .*; trying again until it answers")
        host.cut(False)
        self.await_lines(process, "brightness: started")
        self.flows(self.observe(process))
        self.stop(process)
        self.assert_empty(host)
        # Meanwhile it can be stopped.
        host.cut()
        process = self.start("exec hc run g.toml")
        self.await_lines(process, "; trying again until it answers")
        self.stop(process)
        host.cut(False)

    def test_the_first_link_to_a_host_may_come_later(self):
        (host,) = self.network.add()
        self.write_graph(self.tables(host) + CAMERA.replace('host = "%s"', "") + BRIGHTNESS % "")
        process = self.run_graph("")
        messages = self.observe(process)
        self.state(messages, lambda state: self.rate(state, "camera.left", "brightness.image"))
        asked = "add more@h1 brightness", "link camera.left more.image"
        self.assertEqual(self.ask(process, *asked), ["ok"])
        state = self.state(messages, lambda state: self.rate(state, "camera.left", "more.image"))
        self.assertEqual(self.link(state, "camera.left", "more.image")["transport"], "tls")
        self.assertEqual(self.module(state, "camera")["restarts"], 0)
        self.stop(process)
        self.assert_empty(host)

    def test_a_file_that_is_edited_may_declare_its_first_host(self):
        (host,) = self.network.add()
        here = CAMERA.replace('host = "%s"', "") + BRIGHTNESS % ""
        self.write_graph(here)
        process = self.run_graph("")
        messages = self.observe(process)
        self.state(messages, lambda state: self.rate(state, "camera.left", "brightness.image"))
        more = BRIGHTNESS.replace("brightness", "more") % 'program = "brightness"\n%s'

        def runs_at(place):
            def is_there(state):
                link = self.link(state, "camera.left", "more.image")
                return (
                    self.rate(state, "camera.left", "more.image")
                    and (link["transport"] == "tls") == bool(place)
                    and self.module(state, "more")["host"] == place
                )

            return is_there

        # It moves from one host to the other, and back.
        for place in "h1", "", "h1":
            self.write_graph(self.tables(host) + here + more % (place and 'host = "h1"\n'))
            state = self.state(messages, runs_at(place))
            self.assertEqual("more" in self.modules_of(host), bool(place))
        self.assertEqual(self.module(state, "camera")["restarts"], 0)
        self.stop(process)
        self.assert_empty(host)

    def test_who_reads_no_more_makes_nobody_wait(self):
        (host,) = self.network.add()
        for writes, reads in (("", "h1"), ("h1", "")):
            self.write_graph(
                self.tables(host)
                + CAMERA % writes
                + BRIGHTNESS % ""
                + '[modules.once]\nprogram = "brightness"\nhost = "%s"\n' % reads
                + 'inputs.image = { from = "camera.left", keep = "all" }\n'
            )
            process = self.run_graph("", "once: started")
            messages = self.observe(process)
            state = self.state(
                messages, lambda state: self.rate(state, "camera.left", "once.image")
            )
            os.kill(self.module(state, "once")["pid"], signal.SIGTERM)
            state = self.state(
                messages, lambda state: self.module(state, "once")["status"] == "ended"
            )
            before = self.link(state, "camera.left", "brightness.image")["messages"]
            # More than what waits on the way to a reader that takes nothing.
            self.state(
                messages,
                lambda state: self.link(state, "camera.left", "brightness.image")["messages"]
                > before + 100,
            )
            self.stop(process)
            self.assert_empty(host)

    def test_three_hosts_and_a_recording(self):
        first, second, third = self.network.add(3)
        text = self.tables(first, second, third) + CAMERA % "h1" + BRIGHTNESS % 'host = "h2"\n'
        self.write_graph(text + BRIGHTNESS.replace("brightness]", "other]") % 'host = "h3"\n')
        self.write_graph(
            self.read("g.toml")
            .replace("version = 1\n", "")
            .replace("[modules.other]", "[modules.other]\nprogram = 'brightness'")
        )
        process = self.run_graph("--record all.mcap", "other: started")
        messages = self.observe(process)
        for link in (("camera.left", "brightness.image"), ("camera.left", "other.image")):
            # The writer reports the rate, the reader the age.
            state = self.state(
                messages, lambda state: self.rate(state, *link) and self.link(state, *link)["age"]
            )
            self.assertEqual(self.link(state, *link)["transport"], "tls")
            self.assertLess(self.link(state, *link)["age"][0], 60)
        self.state(
            messages,
            lambda state: any(
                each["to"].startswith("recorder.")
                and each["from"] == "camera.left"
                and each["messages"] > 20
                for each in state["links"]
            ),
        )
        self.refuses_who_has_no_key(first)
        self.stop(process)
        self.assert_empty(first, second, third)
        self.assertRegex(self.shell("hc info all.mcap"), "camera.left")

    def test_a_recording_into_a_folder(self):
        first, second = self.network.add(2)
        self.write_graph(self.tables(first, second) + DELAYS)
        self.shell("mkdir kept; echo other >kept/other")
        self.shell("timeout %d hc run g.toml --quiet --record kept" % WATCHDOG)
        self.assert_empty(first, second)
        # What is linked, the result at the end, and the traces of all modules, and nothing else.
        outputs = ["source.command", "one.out", "two.out", "three.out", "four.out"]
        traces = [name + ".trace" for name in ("source", "one", "two", "three", "four")]
        files = sorted(["other", *(name + ".mtp" for name in [*outputs, *traces])])
        self.assertEqual(sorted(os.listdir(self.path("kept"))), files)
        kept = {name: read_messages(self.path("kept/%s.mtp" % name)) for name in outputs}
        count = len(kept["source.command"])
        self.assertGreater(count, 2)
        self.assertEqual({len(each) for each in kept.values()}, {count})
        # An output has the time of what it was made from.
        times = [message.time for message in kept["source.command"]]
        self.assertEqual([message.time for message in kept["three.out"]], times)
        self.assertIn("%d messages" % count, self.shell("hc info kept/two.out.mtp"))
        out = self.shell("hc replay kept --graph g.toml --check")
        for name in ("one.out", "two.out", "three.out"):
            self.assertIn("%s: %d messages, the same\n" % (name, count), out)
        out = self.shell("hc trace four.in --graph g.toml --recording kept")
        self.assertIn("critical path of %d of %d" % (count, count), out)
        self.assert_empty(first, second)

    def test_what_a_host_lacks_is_named_before_anything_starts(self):
        (host,) = self.network.add()
        wrong = CAMERA.replace("camera]", "camera]\nprogram = 'camra'")
        camera = CAMERA.replace("HappyFish", "no_such") % "h1"
        unreachable = self.tables(host).replace(host.address, "10.9.0.99")
        other = self.write_program(
            "other_hc", '#!/bin/sh\nexec %s agent | sed -u %s"9.9.9"/\'\n' % (HC, VERSION)
        )
        noisy = self.write_program("noisy_hc", "#!/bin/sh\necho Welcome!\nexec %s agent\n" % HC)
        liar = self.write_program(
            "liar_hc", "#!/bin/sh\n%s agent | sed -u %s1234567/'\n" % (HC, VERSION)
        )
        for text, words in (
            (
                self.tables(host) + wrong % "h1",
                'g.toml:8: host h1: no program "camra", did you mean "camera"',
            ),
            (self.tables(host) + CAMERA % "robot", 'g.toml:8: no host "robot"'),
            (
                self.network.table(host, "/no/hc") + CAMERA % "h1",
                "g.toml:2: host h1: .*/no/hc.*hc = ",
            ),
            (
                self.network.table(host, other) + CAMERA % "h1",
                "host h1: it has hc 9.9.9, but this is",
            ),
            (
                self.network.table(host, noisy) + CAMERA % "h1",
                "host h1: not an MTP message: .*bashrc, must print nothing",
            ),
            (
                self.network.table(host, liar) + CAMERA % "h1",
                "host h1: malformed message: .*must be string",
            ),
            (unreachable + CAMERA % "h1", "g.toml:2: host h1: (ssh: connect|Host key|No ED25519)"),
            (
                self.tables(host) + camera,
                "host h1: camera: parameter source: .*no_such.* does not exist",
            ),
        ):
            self.write_graph(text)
            self.shell("hc check g.toml", 2)
            self.assertRegex(self.err, words)
            self.assert_empty(host)
        self.shell("hc doctor g.toml", 1)
        self.write_graph(self.tables(host) + CAMERA % "h1")
        self.assertRegex(self.shell("hc doctor g.toml || true"), "ok +host h1 +connected")

    def test_the_document(self):
        from documents_test import Documents

        (host,) = self.network.add()
        self.network.write("names", "Host robot\n  HostName %s\n" % host.address)
        folder = self.network.folder
        ssh = pathlib.Path(folder, "ssh")
        ssh.write_text('#!/bin/sh\nexec /usr/bin/ssh -F %s/all "$@"\n' % folder)
        ssh.chmod(0o755)
        self.network.write("all", "Include %s/names\nInclude %s/ssh_config\n" % (folder, folder))
        self.environment["PATH"] = folder + ":" + self.environment["PATH"]
        self.commands = lambda name: Documents.commands(self, name)
        Documents.run_document(self, "doc/hosts.md")
        self.assert_empty(host)

    def test_the_head_on_another_host(self):
        (host,) = self.network.add()
        self.network.write("names", "Host robot\n  HostName %s\n" % host.address)
        graph = (ROOT / "graphs/score_track.toml").read_text().partition("version = 1\n")[2]
        graph = graph.replace(
            "[graphs.head]", self.network.table(host, HC) + "[graphs.head]\nhost = 'h1'"
        )
        graph = graph.replace(
            '"simulated_head.toml"', '"%s"' % (ROOT / "graphs/simulated_head.toml")
        )
        self.write_graph(graph)
        out = self.shell("hc run --quiet g.toml")
        self.assertLess(float(re.search(r"track_score: .*RMS error ([\d.]+)°", out)[1]), 10)
        self.assert_empty(host)

    # DDS.

    def test_a_topic_of_dds_for_two_hosts(self):
        first, second = self.network.add(2)
        other = BRIGHTNESS.replace(
            "[modules.brightness]", "[modules.other]\nprogram = 'brightness'"
        )
        via = 'inputs.image = { from = "camera.left", via = "dds" }'
        self.write_graph(
            self.tables(first, second)
            + CAMERA % ""
            + (BRIGHTNESS % 'host = "h1"\n' + other % 'host = "h2"\n').replace(
                'inputs.image = "camera.left"', via
            )
        )
        self.assertIn("no problems found", self.shell("hc check g.toml"))
        process = self.run_graph("", "other: started")
        messages = self.observe(process)
        links = [("camera.left", "brightness.image"), ("camera.left", "other.image")]

        def both_flow(state):
            return all(self.rate(state, *link) for link in links)

        state = self.state(messages, both_flow)
        self.assertEqual({self.link(state, *link)["transport"] for link in links}, {"dds"})
        # Each host has joined the group, and the bridge carries what is sent to it.
        for host in (first, second):
            self.assertIn("239.255.0.1", self.groups(host))
        # One reader is killed, and comes back; the other notices nothing.
        killed = self.modules_of(second)["other"]
        self.kill(killed)
        state = self.state(
            messages, lambda state: self.module(state, "other")["pid"] not in (0, killed)
        )
        before = self.link(state, *links[0])["messages"]
        state = self.state(
            messages,
            lambda state: both_flow(state) and self.link(state, *links[0])["messages"] > before,
        )
        # A host is cut off, and comes back.
        second.cut()
        state = self.state(
            messages, lambda state: self.module(state, "other")["status"] == "waiting"
        )
        before = self.link(state, *links[0])["messages"]
        self.state(
            messages,
            lambda state: self.rate(state, *links[0])
            and self.link(state, *links[0])["messages"] > before + 100,
        )
        second.cut(False)
        self.state(messages, both_flow)
        self.stop(process)
        self.assert_empty(first, second)

    def test_dds_comes_in_over_loopback_alone_unless_it_is_asked(self):
        (host,) = self.network.add()
        reads = [HC, "cat", "--count", "1", "dds:alone"]
        here = subprocess.Popen(reads, stdout=-1)
        self.addCleanup(here.kill)
        open_to_it = subprocess.Popen(
            [*reads[:-1], "dds:alone?interface=10.9.0.1"], stdout=subprocess.PIPE
        )
        self.addCleanup(open_to_it.kill)
        text = "%s send --text 'from another host' --out 'dds:alone?readers=1&interface=%s'"
        host.inside(text % (HC, host.address), timeout=WATCHDOG)
        self.assertIn(b"from another host", open_to_it.communicate(timeout=WATCHDOG)[0])
        subprocess.run(
            [HC, "send", "--text", "from here", "--out", "dds:alone?readers=1"], check=True
        )
        self.assertIn(b"from here", here.communicate(timeout=WATCHDOG)[0])

    @staticmethod
    def groups(host):
        return host.inside("ip maddress show dev eth", stdout=-1).stdout.decode()


if __name__ == "__main__":
    unittest.main()
