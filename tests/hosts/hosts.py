# SPDX-License-Identifier: Apache-2.0
"""What tests of graphs over several hosts share. To be imported first: it changes the network.

HC_FULL=1: all is done as often, and held to the times, as doc/hosts.md promises.
"""

import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time

from network import Network, enter_own_network

enter_own_network()
sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "pipes"))

from graphs import Graphs  # noqa: E402
from harness import BUILD, DATA, ROOT, WATCHDOG, wait_until  # noqa: E402, F401

HC = str(BUILD / "bin/hc")
FULL = bool(os.environ.get("HC_FULL"))
# Until nothing of ours is left [s].
TO_END = 5 if FULL else WATCHDOG
# The eyes on one host, what sees on another, or here.
CAMERA = """
[modules.camera]
host = "%s"
parameters = { source = "{0}/HappyFish.jpg", loop = true, rate = 50, width = 80, height = 60 }
""".replace(
    "{0}", DATA
)
BRIGHTNESS = '[modules.brightness]\n%sinputs.image = "camera.left"\n'


def report(text, *values):
    """Says what was found, where all is done in full."""
    if FULL:
        print(text % values)


class HostsTest(Graphs):
    def setUp(self):
        super().setUp()
        keys = tempfile.TemporaryDirectory()
        self.addCleanup(keys.cleanup)
        subprocess.run(["ip", "link", "del", "bridge"], stderr=-3, check=False)
        self.network = Network(keys.name, BUILD)
        self.addCleanup(self.network.end)

    def tables(self, *hosts, more=""):
        return "".join(self.network.table(host, HC, more=more) for host in hosts)

    def modules_of(self, host):
        """Programs of modules on a host, by the name of the module."""
        found = {}
        for number, text in host.processes().items():
            if name := re.search(r"--name (\S+)", text):
                if "guard" != pathlib.Path("/proc/%d/comm" % number).read_text().strip():
                    found[name[1]] = number
        return found

    def agent_of(self, host):
        return next(
            number
            for number, text in host.processes().items()
            if text.endswith("hc agent")
            and "guard" != pathlib.Path("/proc/%d/comm" % number).read_text().strip()
        )

    def flows(self, messages, before=0):
        """Waits until the link works; its counts stay those of all processes of a module."""
        return self.state(
            messages,
            lambda state: state["links"]
            and state["links"][0]["messages"] > before
            and state["links"][0]["per_second"] > 0
            and all(each["connected"] for each in state["hosts"]),
        )

    def assert_empty(self, *hosts):
        """Nothing of ours is on these hosts, soon."""
        end = time.monotonic() + TO_END
        while any(self.ours(host) for host in hosts):
            self.assertLess(time.monotonic(), end, [self.ours(host) for host in hosts])
            time.sleep(0.02)

    def ours(self, host):
        left = {n: t for n, t in host.processes().items() if "/usr/sbin/sshd -D" not in t}
        for line in host.inside("cat /proc/net/unix", stdout=-1).stdout.decode().splitlines():
            if "@hc-" in line or "@hypercolumn" in line:
                left[line.split()[-1]] = line
        return left

    @staticmethod
    def link(state, source, target):
        return next((e for e in state["links"] if (e["from"], e["to"]) == (source, target)), None)

    def rate(self, state, source, target):
        link = self.link(state, source, target)
        return link and link["per_second"] > 0

    def write_program(self, name, text):
        self.write(name, text, 0o755)
        return self.path(name)

    def kill(self, number):
        os.kill(number, signal.SIGKILL)

    def child_of_sshd(self, host):
        """The process of sshd between the agent and the network."""
        stat = pathlib.Path("/proc/%d/stat" % self.agent_of(host)).read_text()
        return int(stat.rpartition(")")[2].split()[1])

    def run_two(self, host):
        """A graph with a camera on a host, and its process, messages and first state."""
        self.write_graph(self.tables(host) + CAMERA % "h1" + BRIGHTNESS % "")
        process = self.run_graph()
        messages = self.observe(process)
        return process, messages, self.flows(messages)

    def own_programs(self):
        mine = os.readlink("/proc/self/ns/net")
        for path in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if os.readlink(path / "ns/net") == mine:
                    yield (path / "cmdline").read_bytes().decode().replace("\0", " ")
            except OSError:
                pass

    @staticmethod
    def ports_of(host):
        """Those where modules listen."""
        table = host.inside("cat /proc/net/tcp", stdout=-1).stdout.decode()
        ports = [int(row.split()[1][9:], 16) for row in table.splitlines()[1:] if " 0A " in row]
        return [port for port in ports if port != 22]

    @staticmethod
    def connect_by_tls(host, port, more=""):
        command = "openssl s_client -connect %s:%d -quiet %s" % (host.address, port, more)
        return subprocess.run(command.split(), stdin=-3, stdout=-1, stderr=-1, timeout=WATCHDOG)

    def refuses_who_has_no_key(self, host):
        """All ports that modules listen at speak TLS alone, and close before a byte of MTP."""
        ports = self.ports_of(host)
        self.assertGreaterEqual(len(ports), 2)
        for port in ports:
            with socket.create_connection((host.address, port), WATCHDOG) as plain:
                plain.sendall(b"GET / HTTP/1.0\r\n\r\n")
                try:
                    answer = plain.recv(100)
                except ConnectionResetError:
                    answer = b""
                self.assertTrue(answer == b"" or answer[0] == 0x15, answer)  # an alert
            done = self.connect_by_tls(host, port)
            self.assertEqual(done.stdout, b"")
            self.assertIn(b"alert certificate required", done.stderr)
