#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Links whose peer vanishes and comes back: two network namespaces, and a cable that can be pulled.

And more clients than a server has descriptors. In full, by HC_FULL=1, the times are required: a
peer that vanishes is noticed within 4 s, and a link is in use again within 2 s of the network's return.
"""

import json
import os
import pathlib
import re
import socket
import subprocess
import time
import unittest

from harness import PYTHON, Pipes, WATCHDOG, free_port, listens, wait_until
from namespaces import NSENTER, UNSHARE

FULL = bool(os.environ.get("HC_FULL"))
NOTICED, BACK = (4.0, 2.0) if FULL else (WATCHDOG, WATCHDOG)  # [s]
HERE, THERE = "10.213.77.1", "10.213.77.2"
LATE = "10.213.78.1"
# Inside the first namespace: makes the second, ties them together, and keeps both.
CABLE = """
ip link set lo up
unshare -n sleep 1000 & far=$!
while [ "$(readlink /proc/$far/ns/net)" = "$(readlink /proc/$$/ns/net)" ]; do :; done
ip link add near type veth peer name far netns $far
ip address add %s/30 dev near && ip link set near up
nsenter -t $far -n ip address add %s/30 dev far && nsenter -t $far -n ip link set far up
echo $$ $far
read -r _
kill $far
""" % (
    HERE,
    THERE,
)


class Network(Pipes):
    def setUp(self):
        super().setUp()
        self.cable = subprocess.Popen(
            [*UNSHARE, "--net", "sh", "-c", CABLE], stdin=-1, stdout=-1, stderr=-1, text=True
        )
        self.addCleanup(self.cut)
        line = self.cable.stdout.readline().split()
        if len(line) != 2:
            self.skipTest("no network namespaces: " + self.cable.communicate()[1].strip())
        self.near, self.far = line

    def cut(self):
        self.cable.communicate()

    def within(self, where, command, **options):
        """Starts a command in a namespace: self.near or self.far."""
        enter = "exec %s -t %s -n " % (" ".join(NSENTER), where)
        return self.start(enter + command, **options)

    def configure(self, command):
        """Runs a command of `ip` in the first namespace."""
        subprocess.run([*NSENTER, "-t", self.near, "-n", "ip", *command.split()], check=True)

    def set_cable(self, state):
        self.configure("link set near " + state)

    def listens_there(self, port):
        table = pathlib.Path("/proc/%s/net/tcp" % self.far).read_text()
        return ":%04X 00000000:0000 0A" % port in table

    def recording(self):
        self.shell("for i in 1 2 3; do hc send --seq $i --type position 1 2 3; done > few.mtp")
        return "hc play few.mtp --loop --speed max --out "

    def is_within(self, what, begin, limit):
        seconds = time.monotonic() - begin
        print("%s after %.2f s" % (what, seconds), flush=True)
        self.assertLess(seconds, limit)

    def is_noticed(self, what, left):
        """Pulls the cable, and waits until the other modules end."""
        self.set_cable("down")
        begin = time.monotonic()
        left.wait(timeout=WATCHDOG)
        self.is_within(what, begin, NOTICED)

    def test_a_busy_reader_that_vanishes_is_noticed(self):
        play = self.recording()
        reader = self.within(self.far, "hc cat --json tcp-listen:%s:7000" % THERE)
        wait_until(lambda: self.listens_there(7000))
        writer = self.within(self.near, play + "'tcp:%s:7000?rate=100'" % THERE)
        reader.stdout.readline()
        self.is_noticed("busy writer noticed", writer)

    def test_an_idle_writer_that_vanishes_is_noticed(self):
        self.within(self.far, "hc play - --out tcp-listen:%s:7000" % THERE, stdin=-1)
        wait_until(lambda: self.listens_there(7000))
        reader = self.within(self.near, "hc cat --json tcp:%s:7000" % THERE)
        wait_until(lambda: self.is_established(7000))
        self.is_noticed("idle reader noticed", reader)

    def is_established(self, port):
        table = pathlib.Path("/proc/%s/net/tcp" % self.near).read_text()
        return ":%04X 01 " % port in table

    def check_return(self, reader):
        """A link is in use; the cable is pulled until the peers have given each other up."""
        reader.stdout.readline()
        for pause in (1.5, 3.2, 6.0) if FULL else (0,):
            self.set_cable("down")
            wait_until(lambda: not self.is_established(7000))
            time.sleep(pause)  # the requirement is about time
            os.set_blocking(reader.stdout.fileno(), False)
            while reader.stdout.read():
                pass
            os.set_blocking(reader.stdout.fileno(), True)
            self.set_cable("up")
            begin = time.monotonic()
            self.assertTrue(reader.stdout.readline())
            self.is_within("in use again, %.1f s away," % pause, begin, BACK)

    def test_a_sink_that_connects_is_soon_in_use_again(self):
        reader = self.within(self.far, "hc cat --json tcp-listen:%s:7000" % THERE)
        wait_until(lambda: self.listens_there(7000))
        self.within(self.near, self.recording() + "'tcp:%s:7000?rate=50&reconnect=60'" % THERE)
        self.check_return(reader)

    def test_a_source_that_connects_is_soon_in_use_again(self):
        self.within(self.far, self.recording() + "'tcp-listen:%s:7000?rate=50'" % THERE)
        reader = self.within(self.near, "hc cat --json 'tcp:%s:7000?reconnect=60'" % THERE)
        self.check_return(reader)

    def add_address(self):
        self.configure("address add %s/32 dev near" % LATE)

    def check_late_address(self, reader, send, said):
        """A reader waits for an address that comes after its start, and says so once."""
        waiting = self.within(self.near, reader % LATE + " --count 1")
        line = waiting.stderr.readline().decode()
        self.assertIn(said, line)
        self.add_address()
        sender = self.within(self.near, send % LATE)
        out, err = waiting.communicate(timeout=WATCHDOG)
        self.assertEqual(waiting.returncode, 0, line + err.decode())
        self.assertEqual(err, b"")  # it was said once
        self.assertEqual(json.loads(out)["elements"], [[5]])
        self.assertEqual(sender.wait(timeout=WATCHDOG), 0)

    NOT_YET = "this host does not have the address yet; waiting"

    def test_a_tcp_address_that_comes_late_is_listened_on(self):
        self.check_late_address(
            "hc cat --json tcp-listen:%s:7000", "hc send 5 --out tcp:%s:7000", self.NOT_YET
        )

    def test_a_tls_address_that_comes_late_is_listened_on(self):
        self.shell("hc key k.pem")
        ends = "?key=k.pem&peer=k.pem"
        self.check_late_address(
            "hc cat --json 'tls-listen:%%s:7000%s'" % ends,
            "hc send 5 --out 'tls:%%s:7000%s'" % ends,
            self.NOT_YET,
        )

    def test_an_interface_of_dds_that_comes_late_is_used(self):
        topic = "'dds:late?interface=%s'"
        self.check_late_address(
            "hc cat --json " + topic,
            "hc send 5 --out " + topic,
            "no network interface of this host that is up has the address %s; waiting" % LATE,
        )

    def test_a_page_at_an_address_that_comes_late_is_served(self):
        self.write(
            "g.toml",
            "version = 1\n[modules.web]\nparameters = { listen = '%s', port = 7443 }\n" % LATE,
        )
        graph = self.within(self.near, "hc run g.toml 2>log")
        wait_until(lambda: "web: listen %s: %s\n" % (LATE, self.NOT_YET) in self.read("log"))
        self.add_address()
        visitor = self.within(self.near, "bash -c 'exec 3<>/dev/tcp/%s/7443'" % LATE)
        self.assertEqual(visitor.wait(timeout=WATCHDOG), 0)
        graph.terminate()
        graph.wait(timeout=WATCHDOG)
        self.assertEqual(self.read("log").count("web: started"), 1)

    def test_a_port_in_use_is_an_error_also_at_an_address_of_this_host(self):
        self.within(self.near, "hc cat tcp-listen:%s:7000" % HERE)
        table = pathlib.Path("/proc/%s/net/tcp" % self.near)
        wait_until(lambda: ":%04X 00000000:0000 0A" % 7000 in table.read_text())
        other = self.within(self.near, "hc cat tcp-listen:%s:7000" % HERE)
        self.assertIn(b"Address already in use", other.communicate(timeout=WATCHDOG)[1])
        self.assertEqual(other.returncode, 1)

    def test_a_head_tracker_hears_the_machine_that_is_named(self):
        send = (
            "import socket, struct; s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM);"
            "s.sendto(struct.pack('<6d', 0, 0, 0, -20, 0, 0), ('%s', 4242)); s.recv(1)" % HERE
        )
        for sender, said in (
            (
                HERE,
                "ignored a packet of %s port [0-9]+: another host, not listed in `sender`" % THERE,
            ),
            (HERE + " " + THERE, "receiving from the tracker"),
        ):
            tracker = self.within(
                self.near,
                "hc head_tracker 0.0.0.0:4242 --centre_first=false --sender '%s'"
                " --out rotation=file:rotation 2>&1" % sender,
            )
            while b"listening on UDP" not in tracker.stdout.readline():
                self.assertIsNone(tracker.poll())
            other = self.within(self.far, '%s -c "%s"' % (PYTHON, send))
            lines = iter(tracker.stdout.readline, b"")
            self.assertTrue(any(re.search(said, line.decode()) for line in lines))
            if THERE in sender:
                wait_until(lambda: "0.349" in self.read("rotation"))
            for process in (other, tracker):
                self.end(process)
            self.assertEqual("0.349" in self.read("rotation"), THERE in sender)


class ManyClients(Pipes):
    def cpu_seconds(self, pid):
        fields = pathlib.Path("/proc/%d/stat" % pid).read_text().rsplit(") ", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def check(self, command, is_served):
        """200 clients at a server that has room for some 50 of them."""
        port = free_port()
        server = self.start("ulimit -n 64; exec " + command % port)
        wait_until(lambda: listens(port))
        clients = [socket.create_connection(("127.0.0.1", port)) for _ in range(200)]
        for client in clients:
            self.addCleanup(client.close)
        time.sleep(0.5)
        begin, used = time.monotonic(), self.cpu_seconds(server.pid)
        time.sleep(2)
        share = (self.cpu_seconds(server.pid) - used) / (time.monotonic() - begin)
        print("200 clients: %.1f %% of a processor" % (100 * share), flush=True)
        self.assertLess(share, 0.05)
        for client in clients[:-1]:
            client.close()
        is_served(server, clients[-1])
        clients[-1].close()

    def test_a_listening_source_recovers(self):
        def is_served(server, client):
            client.sendall(b"1 7 0 1 8 0 10390 1 3 1 1\n0.1 0.2 0.3\n")
            self.assertEqual(json.loads(server.stdout.readline())["elements"], [[[0.1, 0.2, 0.3]]])

        self.check("hc cat --json tcp-listen:%d", is_served)

    def test_a_listening_sink_recovers(self):
        def is_served(_, client):
            client.settimeout(WATCHDOG)
            self.assertTrue(client.recv(1))

        messages = "while echo 1 7 0 1 8 0 10390 1 3 1 1 && echo 1 2 3; do :; done"
        play = "hc play - --speed max --out 'tcp-listen:%%d?rate=20' < <(%s)" % messages
        self.check(play, is_served)


if __name__ == "__main__":
    unittest.main()
