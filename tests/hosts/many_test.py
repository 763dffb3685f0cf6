#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Many hosts with ten modules each: how long they take to start and to stop, and what they cost the
runner. Needs root.

    many_test.py BUILD_FOLDER [TEST …]

HC_FULL=1 does it with 1, 10 and 30 hosts, and holds it to the times that doc/hosts.md promises.
"""

import json
import pathlib
import time
import unittest

from hosts import DATA, FULL, HostsTest, report

MODULES = 10
COUNTS = (1, 10, 30) if FULL else (4,)
TO_START, TO_STOP = (30, 5) if FULL else (100, 100)  # [s]
WATCHED = 10 if FULL else 2  # the time over which the runner's load is taken [s]


class Many(HostsTest):
    def graph(self, hosts):
        """On each host a camera and nine that look at it, but for one, which looks at the next host's."""
        text = self.tables(*hosts)
        for i, host in enumerate(hosts):
            text += '[modules.camera_%d]\nprogram = "camera"\nhost = "%s"\n' % (i, host.name)
            text += 'parameters = { source = "%s/aloeL.jpg", loop = true, rate = 5, ' % DATA
            text += "width = 80, height = 60 }\n"
            for j in range(MODULES - 1):
                seen = (i + 1) % len(hosts) if j == 0 else i
                text += '[modules.look_%d_%d]\nprogram = "brightness"\nhost = "%s"\n' % (
                    i,
                    j,
                    host.name,
                )
                text += 'inputs.image = "camera_%d.left"\n' % seen
        return text

    def test_many_hosts(self):
        for count in COUNTS:
            self.network.add(count - len(self.network.hosts))
            hosts = self.network.hosts
            self.write_graph(self.graph(hosts))
            begun = time.monotonic()
            process = self.start("exec hc run --quiet g.toml >/dev/null 2>errors")
            messages = self.observed(process)
            state = self.state(messages, self.runs)
            started = time.monotonic() - begun
            self.is_right(state, hosts)
            self.assertEqual(state["modules"], sorted(state["modules"], key=self.place_of))
            top = json.loads(self.shell("hc top --once --json").splitlines()[0])
            self.is_right(top, hosts)
            load = self.load(process, messages)
            begun = time.monotonic()
            self.stop(process)
            for host in hosts:
                self.assert_empty(host)
            stopped = time.monotonic() - begun
            report(
                "%d hosts: started in %.1f s, stopped in %.1f s, hc run took %.1f %% of a processor",
                *(count, started, stopped, 100 * load),
            )
            self.assertLess(started, TO_START)
            self.assertLess(stopped, TO_STOP)

    @staticmethod
    def place_of(module):
        words = module["name"].split("_")
        return (int(words[1]), words[0] != "camera", int(words[-1]))

    def runs(self, state):
        return (
            self.all_run(state)
            and all(each["per_second"] > 0 for each in state["links"])
            and all(each["connected"] for each in state["hosts"])
        )

    def is_right(self, state, hosts):
        """What is said of modules, links and hosts is what there is."""
        self.assertEqual({each["name"] for each in state["hosts"]}, {each.name for each in hosts})
        self.assertEqual(len(state["links"]), len(hosts) * (MODULES - 1))
        for host in hosts:
            there = {
                each["name"]: each["pid"] for each in state["modules"] if each["host"] == host.name
            }
            self.assertEqual(there, self.modules_of(host))
            self.assertEqual(len(there), MODULES)
        for link in state["links"]:
            is_between = link["from"].split(".")[0].split("_")[1] != link["to"].split("_")[1]
            self.assertEqual(link["transport"], "tls" if is_between else "shm", link)

    def load(self, process, messages):
        """Part of a processor that `hc run` takes, without its children."""

        def used():
            threads = pathlib.Path("/proc/%d/task" % process.pid).glob("*/schedstat")
            return sum(int(each.read_text().split()[0]) for each in threads) / 1e9

        before, begun = used(), time.monotonic()
        self.state(messages, lambda state: time.monotonic() > begun + WATCHED)
        return (used() - before) / (time.monotonic() - begun)


if __name__ == "__main__":
    unittest.main()
