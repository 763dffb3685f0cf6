# SPDX-License-Identifier: Apache-2.0
"""Hosts for tests: network namespaces with an sshd in each, joined by a bridge, removed with the test.

The test itself runs in a namespace of its own, as the host of `hc run`: 10.9.0.1. Needs root.
"""

import os
import pathlib
import shlex
import signal
import subprocess
import sys
import time

SSHD_SESSIONS = ("sshd:", "sshd-session:")  # before and since OpenSSH 9.8
SSHD = """
Port 22
ListenAddress 0.0.0.0
HostKey {folder}/host_key
AuthorizedKeysFile {folder}/user_key.pub
PidFile none
StrictModes no
UsePAM no
PasswordAuthentication no
PermitRootLogin prohibit-password
MaxStartups 100
MaxSessions 100
SetEnv PATH={build}/bin:/usr/local/bin:/usr/bin:/bin
LogLevel QUIET
"""
SSH = """
Host *
  User root
  IdentityFile {folder}/user_key
  IdentitiesOnly yes
  UserKnownHostsFile {folder}/known_hosts
  StrictHostKeyChecking yes
"""


def enter_own_network():
    """Has the program go on in a network and a process namespace of its own, which ends with it and
    ends all that it has started, even when it is killed. To be called before all else."""
    if os.geteuid() != 0:
        sys.exit("these tests need root: they make networks, and start an sshd in each")
    if os.environ.pop("HC_ALONE", None) is not None:
        return
    os.environ["HC_ALONE"] = "1"
    alone = ["unshare", "--net", "--pid", "--fork", "--kill-child", "--mount-proc"]
    # The first process is a shell, which waits for whatever has lost its parent.
    first = ["sh", "-c", '"$@"; exit $?', "sh", sys.executable, *sys.argv]
    os.execvp("unshare", [*alone, *first])


def run(command, **options):
    return subprocess.run(shlex.split(command), check=True, **options)


class Host:
    """A host of the network: its namespace is that of a process that does nothing."""

    def __init__(self, number, config, cable=None):
        self.name = "h%d" % number
        self.address = "10.9.0.%d" % (number + 1)
        self.process = subprocess.Popen(["unshare", "--net", "sleep", "infinity"])
        self.sshd = self.cable = None
        own = os.readlink("/proc/self/ns/net")
        while os.readlink("/proc/%d/ns/net" % self.process.pid) == own:
            time.sleep(0.001)  # it has not got there yet
        if cable is None:
            run("ip link add %s type veth peer name eth netns %d" % (self.name, self.process.pid))
        else:
            far = self.name + "_far"
            self.cable = subprocess.Popen([cable, self.name, far], stdin=-1, stdout=-1)
            assert self.cable.stdout.readline(), "there is no cable: see above"
            run("ip link set %s netns %d name eth" % (far, self.process.pid))
        run("ip link set %s master bridge up" % self.name)
        self.inside("ip address add %s/24 dev eth" % self.address)
        self.inside("ip link set eth up")
        self.inside("ip link set lo up")
        sshd = self.enter("/usr/sbin/sshd -D -e -f %s" % config)
        self.sshd = subprocess.Popen(sshd, stdin=-3, stderr=-3, start_new_session=True)
        # Port 22, listening: asked of the kernel, and not by connecting.
        listens = pathlib.Path("/proc/%d/net/tcp" % self.process.pid)
        while ":0016 00000000:0000 0A" not in listens.read_text():
            time.sleep(0.01)

    def enter(self, command):
        return ["nsenter", "--net=/proc/%d/ns/net" % self.process.pid, *shlex.split(command)]

    def inside(self, command, **options):
        return subprocess.run(self.enter(command), check=True, **options)

    def processes(self):
        """Numbers and command lines of all programs of this host, without what makes the host."""
        mine = os.readlink("/proc/%d/ns/net" % self.process.pid)
        found = {}
        for path in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                words = (path / "cmdline").read_bytes().decode(errors="replace").split("\0")
                is_here = os.readlink(path / "ns/net") == mine
            except OSError:
                continue
            if is_here and words != [""] and int(path.name) != self.process.pid:
                found[int(path.name)] = " ".join(words).strip()
        return {
            number: text for number, text in found.items() if not text.startswith(SSHD_SESSIONS)
        }

    def worsen(self, delay=0, loss=0, rate=0):
        """How its cable is from now on: late [ms], loses packets [1], slow [byte/s]."""
        self.cable.stdin.write(b"%g %g %d\n" % (delay, loss, rate))
        self.cable.stdin.flush()
        self.cable.stdout.readline()

    def cut(self, is_cut=True):
        run("ip link set %s %s" % (self.name, "down" if is_cut else "up"))

    def end(self):
        for number, text in self.processes().items():
            if "/usr/sbin/sshd -D" not in text:
                os.kill(number, signal.SIGKILL)
        if self.cable is not None:
            self.cable.stdout.close()
            self.cable.stdin.close()
        else:
            run("ip link delete " + self.name)  # it would end with the namespace, but later
        for process in (self.sshd, self.process, self.cable):
            if process is not None:
                process.kill()
                process.wait()


class Network:
    """The bridge, keys, and hosts that are made when they are asked for."""

    def __init__(self, folder, build):
        self.folder = folder
        self.build = build
        self.hosts = []
        pathlib.Path("/run/sshd").mkdir(exist_ok=True)
        for name in ("host_key", "user_key"):
            run("ssh-keygen -q -t ed25519 -N '' -f %s/%s" % (folder, name))
        self.sshd_config = self.write("sshd_config", SSHD)
        self.ssh_config = self.write("ssh_config", SSH)
        run("ip link set lo up")
        run("ip link add bridge type bridge")
        run("ip address add 10.9.0.1/24 dev bridge")
        run("ip link set bridge up")

    def write(self, name, text):
        path = pathlib.Path(self.folder, name)
        path.write_text(text.format(folder=self.folder, build=self.build))
        return str(path)

    def add(self, count=1, cable=None):
        """Hosts; `cable` is the program that makes bad ones."""
        for _ in range(count):
            self.hosts.append(Host(len(self.hosts) + 1, self.sshd_config, cable))
        key = pathlib.Path(self.folder, "host_key.pub").read_text()
        known = "".join("%s %s" % (host.address, key) for host in self.hosts)
        pathlib.Path(self.folder, "known_hosts").write_text(known)
        return self.hosts[-count:]

    def table(self, host, program, name=None, more=""):
        """[hosts.NAME] of a graph file."""
        ssh = '["-F", "%s", "%s"]' % (self.ssh_config, host.address)
        return '[hosts.%s]\nssh = %s\nhc = "%s"\n%s\n' % (name or host.name, ssh, program, more)

    def end(self):
        for host in self.hosts:
            host.end()
