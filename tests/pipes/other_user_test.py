#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Another user of the host tries every way into the simulated head that SECURITY.md lists, while it
runs, and gets through none: nothing moves, stops, is read or is blocked."""

import json
import os
import pathlib
import re
import subprocess
import unittest

from graphs import Graphs
from harness import BUILD, ROOT, WATCHDOG

NOBODY = 65534
# Of each kind of module one is killed while the intruder waits for the names that it writes to.
KILLED = ["left_ball", "rectify", "head_neck", "head_unit", "head_tracker", "track", "workspace"]


def descendants(number):
    found = [number]
    for task in pathlib.Path("/proc/%d/task" % number).glob("*/children"):
        for child in task.read_text().split():
            found += descendants(int(child))
    return found


def open_files(number):
    """What the descriptors of a process are: "/dev/pts/3", "socket:[4711]"."""
    for path in pathlib.Path("/proc/%d/fd" % number).iterdir():
        try:
            yield os.readlink(path)
        except OSError:
            continue


class OtherUser(Graphs):
    def setUp(self):
        super().setUp()
        if os.geteuid() != 0:
            self.skipTest("only root can be another user")
        program = str(BUILD / "bin/hc")
        self.hc = program if self.run_as_nobody(["test", "-x", program]).wait() == 0 else None

    def run_as_nobody(self, command, **options):
        return subprocess.Popen(
            command, user=NOBODY, group=NOBODY, extra_groups=[], cwd="/", **options
        )

    def start_head(self):
        self.environment.update(HC_HEAD_TRACKER="0", XDG_STATE_HOME=self.folder.name + "/state")
        head = self.start(
            "exec hc run %s/graphs/head.toml --set web.port=0 --set view_left.save=left.png" % ROOT
        )
        self.lines = self.await_lines(head, "web: page: ")
        messages = self.observe(head, "head")
        self.state(messages, self.all_run)
        return head, messages

    def facts(self, head):
        """What anybody can know of the graph, and more."""
        processes = descendants(head.pid)
        files = {file for number in processes for file in open_files(number)}
        names, ports = [], {"tcp": [], "udp": []}
        for line in pathlib.Path("/proc/net/unix").read_text().splitlines()[1:]:
            words = line.split()
            if "socket:[%s]" % words[6] in files and words[7:] and words[7].startswith("@"):
                names.append(words[7][1:])
        for protocol, listens in (("tcp", "0A"), ("udp", "07")):
            for line in pathlib.Path("/proc/net/" + protocol).read_text().splitlines()[1:]:
                words = line.split()
                if "socket:[%s]" % words[9] in files and words[3] == listens:
                    ports[protocol].append(int(words[1].split(":")[1], 16))
        terminals = sorted(file for file in files if file.startswith("/dev/pts/"))
        for found in (names, ports["tcp"], ports["udp"], terminals):
            self.assertTrue(found)
        return dict(
            ports,
            processes=processes,
            names=sorted(set(names)),
            terminals=terminals,
            files=[self.path("left.png"), self.path("new")],
            token=re.search(r"token=(\w+)", self.lines[-1])[1],
            graph="head",
            hc=self.hc,
        )

    def test_no_way_in(self):
        head, messages = self.start_head()
        facts = self.facts(head)
        with open(ROOT / "tests/pipes/intruder.py") as source:
            script = source.read()  # which it may not be able to read
        intruder = self.run_as_nobody(
            ["/usr/bin/python3", "-c", script, json.dumps(facts)], stdin=-1, stdout=-1, text=True
        )
        self.addCleanup(intruder.kill)
        ways = {}
        for line in intruder.stdout:
            if line == "ready\n":
                break
            way, through = line.rstrip("\n").split("\t")
            ways[way] = through
        before = self.state(messages)
        pids = {name: self.module(before, name)["pid"] for name in KILLED}
        for pid in pids.values():
            os.kill(pid, 9)
        after = self.state(
            messages,
            lambda state: self.all_run(state)
            and all(self.module(state, name)["pid"] not in (0, pid) for name, pid in pids.items()),
        )
        out, _ = intruder.communicate(timeout=WATCHDOG)
        self.assertEqual(intruder.returncode, 0)
        ways.update(line.split("\t") for line in out.splitlines())
        kinds = {}
        for way in ways:
            kind = re.sub(r"[@/]\S+|\d+", "…", way)
            kinds[kind] = kinds.get(kind, 0) + 1
        print("tried %d ways in: %s" % (len(ways), kinds), flush=True)
        self.assertGreater(len(ways), 100)
        self.assertEqual({way: through for way, through in ways.items() if through}, {})

        # Nothing came of it: no pose of the tracker, nobody's bid, no stop, no module lost.
        link = {each["from"]: each for each in after["links"]}
        for source in ("head_tracker.rotation", "web.stick", "web.bid"):
            self.assertEqual(link[source]["messages"], 0, source)
        # The page's server says three times that no page is open, and no more.
        self.assertLessEqual(link["web.stop"]["messages"], 3)
        self.assertEqual(after["stopped"], [])
        restarts = {each["name"]: each["restarts"] for each in after["modules"]}
        self.assertEqual({name for name, count in restarts.items() if count}, set(KILLED))
        _, err = self.stop(head)
        self.assertIn("another user (uid %d)" % NOBODY, "\n".join(self.lines) + err)


if __name__ == "__main__":
    unittest.main()
