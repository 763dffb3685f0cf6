# SPDX-License-Identifier: Apache-2.0
"""Tries every way into a running graph of another user (SECURITY.md), as whoever starts it.

    intruder.py FACTS

FACTS is JSON: the names of the graph's sockets, which anybody can see in /proc/net/unix, its
process numbers, terminals, files, ports of UDP and TCP, and a token of its page. Prints a
line for each way in: what it is, a tab, and empty, or what went through. Then takes names that become
free until its standard input ends, and prints those.
"""

import ctypes
import glob
import json
import os
import select
import signal
import socket
import struct
import subprocess
import sys

ANSWER = 3  # [s] that a listener has to answer, which most do at once
COMMANDS = ["stop", "set workspace.rate=1", "restart workspace", "remove head_neck"]
PIDFD_OPEN, PIDFD_GETFD = 434, 438  # the same on all processors


def message(rows):
    width = max(map(len, rows))
    text = "".join(row.ljust(width) for row in rows)
    return b"1 1 0 0 8 0 60101 0 0 %d %d\n%s\n" % (width, len(rows), text.encode())


def try_names(names):
    """Connects to all, writes commands and images to all, and reads what they say."""
    links = {}
    for name in names:
        link = socket.socket(socket.AF_UNIX)
        link.setblocking(False)
        try:
            link.connect("\0" + name)
            links[link] = name
            link.send(message(["reply unix:@intruder"] + COMMANDS))
        except OSError:
            continue
    said = dict.fromkeys(links.values(), b"")
    while links:
        readable = select.select(list(links), [], [], ANSWER)[0]
        if not readable:
            break
        for link in readable:
            try:
                piece = link.recv(1 << 16)
            except OSError:
                piece = b""
            said[links[link]] += piece
            if not piece:
                del links[link]
    for name, text in said.items():
        # Shared memory says why it refuses, and gives no descriptor.
        is_refusal = b"another user" in text
        yield "socket @%s" % name, "" if is_refusal else text[:80].decode(errors="replace")
    for link in links:  # was never accepted, or is not answered
        link.close()


def take_names(names):
    """Those names that could be taken now."""
    for name in names:
        with socket.socket(socket.AF_UNIX) as taken:
            try:
                taken.bind("\0" + name)
            except OSError:
                continue
            yield name


def try_file(path, mode):
    try:
        with open(path, mode) as file:
            if "r" in mode:
                file.read(1)
        return "opened"
    except OSError:
        return ""


def try_process(number):
    folder = "/proc/%d/" % number
    for name in ("environ", "mem", "maps", "syscall", "stack"):
        yield folder + name, try_file(folder + name, "rb")
    try:
        yield folder + "fd", " ".join(os.listdir(folder + "fd"))
    except OSError:
        yield folder + "fd", ""
    call = ctypes.CDLL(None, use_errno=True).syscall
    process = call(PIDFD_OPEN, number, 0)
    for descriptor in (0, 1, 3, 5):
        got = call(PIDFD_GETFD, process, descriptor, 0) if process >= 0 else -1
        yield "descriptor %d of %d" % (descriptor, number), "taken" if got >= 0 else ""
    for each in (signal.SIGSTOP, signal.SIGTERM, signal.SIGKILL, signal.SIGCONT):
        try:
            os.kill(number, each)
            yield "signal %d to %d" % (each, number), "sent"
        except OSError:
            yield "signal %d to %d" % (each, number), ""


def try_page(port, token):
    key = "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
    key += "Sec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\n"
    asked = {
        "/": "",
        "/?token=" + "0" * 32: "",
        "/?token=" + token: "",  # which the command line of a browser told
        "/state": "",
        "/recordings": "",
        "/drive": key,
        "/observe": key,
    }
    for path, more in asked.items():
        with socket.create_connection(("127.0.0.1", port), ANSWER) as link:
            link.sendall(
                ("GET %s HTTP/1.1\r\nHost: 127.0.0.1:%d\r\n%s\r\n" % (path, port, more)).encode()
            )
            link.settimeout(ANSWER)
            try:
                answer = link.recv(4096)
            except OSError:
                answer = b""
        status = int(answer.split()[1]) if answer.startswith(b"HTTP/") else 0
        yield "GET " + path, "" if status == 0 or status >= 400 else answer[:80].decode()


def try_tracker(port):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for _ in range(1000):
            sender.sendto(struct.pack("<6d", 0, 0, 0, 90, 30, 0), ("127.0.0.1", port))


def try_command(hc, words):
    done = subprocess.run([hc, *words], stdin=-3, stdout=-1, stderr=-1, timeout=60)
    return done.stdout.decode()[:80] if done.returncode == 0 else ""


def main():
    facts = json.loads(sys.argv[1])

    def say(way, through):
        print("%s\t%s" % (way, through.replace("\n", " ")), flush=True)

    for found in (
        try_names(facts["names"]),
        *map(try_process, facts["processes"]),
        *(try_page(port, facts["token"]) for port in facts["tcp"]),
    ):
        for way, through in found:
            say(way, through)
    for path in facts["terminals"] + glob.glob("/dev/shm/*hypercolumn*"):
        for mode in ("rb", "wb"):
            say("%s of %s" % (mode, path), try_file(path, mode))
    for path in facts["files"]:
        say("write " + path, try_file(path, "ab"))
    for port in facts["udp"]:
        try_tracker(port)
    for words in (
        ["cat", "head_eyes.left", "--count", "1"],
        ["cat", "%s/workspace.focus" % facts["graph"], "--count", "1"],
        ["page", "--of", facts["graph"]],
        ["graph", "stop"],
        ["graph", "set", "workspace.rate=1"],
    ):
        say("hc " + " ".join(words), try_command(facts["hc"], words))
    for name in take_names(facts["names"]):
        say("taken " + name, "bound")
    print("ready", flush=True)
    taken = set()
    while not select.select([sys.stdin], [], [], 0.001)[0]:
        taken.update(take_names(facts["names"]))
    for name in taken:
        print("%s\tbound while its writer restarted" % name, flush=True)


main()
