#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Recordings of the head while the disk fills, and while those are killed who write them."""

import hashlib
import os
import signal
import subprocess
import time
import unittest

from table import Rows  # which knows the way to the others
from head import SMALL, Head
from namespaces import UNSHARE

DISKS = {"folder": 4, "file.mcap": 1}  # of their own, each full within some seconds [MB]
ALONE = [*UNSHARE, "--mount"]
MOUNT = "%s sh -c 'mount -t tmpfs -o size=%dm none disk && exec \"$@\"' -"
AFTER = 3  # for which a head runs on a full disk [s]
WRITES = 0.3  # how often it is looked how far files are [s]


class Recording:
    """How far the files of a folder were, by time, and whether they still begin so."""

    def __init__(self, folder):
        self.folder, self.seen = os.open(folder, os.O_RDONLY), []

    def files(self):
        """Path below the folder and size."""
        found = {}
        for path, _, names, at in os.fwalk(dir_fd=self.folder):
            for name in names:
                found[os.path.join(path, name)] = os.stat(name, dir_fd=at).st_size
        return found

    def digest(self, name, size):
        """Of so many bytes of a file; None where it has fewer, or is not there any more."""
        try:
            file = os.open(name, os.O_RDONLY, dir_fd=self.folder)
        except FileNotFoundError:
            return None
        with os.fdopen(file, "rb") as stream:
            data = stream.read(size)
        return hashlib.sha256(data).digest() if len(data) == size else None

    def look(self):
        """At most so often as WRITES says, since it reads all."""
        if self.seen and time.monotonic() < self.seen[-1][0] + WRITES:
            return
        sizes = self.files()
        digests = {name: (size, self.digest(name, size)) for name, size in sizes.items()}
        self.seen.append((time.monotonic(), digests))

    def lost(self, moment):
        """Files of which something is lost that was there a second before a moment."""
        before = [digests for at, digests in self.seen if at <= moment - 1]
        last = before[-1] if before else {}
        return {name for name, (size, was) in last.items() if self.digest(name, size) != was}


class Disk(Rows):
    def setUp(self):
        if subprocess.run([*ALONE, "true"], stderr=-3, check=False).returncode != 0:
            self.skipTest("no mount namespaces for this user")
        super().setUp()

    def record(self, prefix, what):
        """A head of its own that is recorded into a file or folder below `disk`."""
        self.head = Head()
        self.addCleanup(self.head.doCleanups)
        self.head.begin(prefix, "--record disk/" + what, is_calibrated=False, **SMALL)
        root = "/proc/%d/root" % self.head.process.pid
        return Recording(root + self.head.path("disk"))

    def watch(self, recording, seconds):
        """Looks how far the files are, for so long."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            recording.look()
            time.sleep(WRITES / 3)

    def test_the_disk_is_full(self):
        for what in ("folder", "file.mcap"):
            recording = self.record(MOUNT % (" ".join(ALONE), DISKS[what]), what)
            before = self.head.restarts(but=["recorder"])
            self.head.wait(lambda: recording.look() or "No space" in self.head.said(), "it is full")
            full = time.monotonic()
            self.watch(recording, AFTER)  # with what is restarted, and what it does to the files
            self.head.wait(self.head.is_going_on, "the robot goes on")
            self.note("lost", len(recording.lost(full)), "%s %s" % (what, recording.lost(full)))
            self.note_ended(before, but=["recorder"], where=what)
        self.hold()

    def test_a_recording_is_killed(self):
        """What writes is a module that is recorded, or `recorder`."""
        for what in ("folder", "file.mcap"):
            recording = self.record("", what)
            self.watch(recording, 2)
            for name in ("head_eyes", "depth", "workspace", "head_unit", "recorder"):
                if name not in self.head.names():
                    continue
                self.head.send_signal(name, signal.SIGKILL)
                killed = time.monotonic()
                self.head.wait(self.head.is_whole, "all run after %s was killed" % name)
                self.watch(recording, 2 * WRITES)
                self.note(
                    "lost",
                    len(recording.lost(killed + 1)),
                    "%s %s" % (name, recording.lost(killed)),
                )
        self.hold()


if __name__ == "__main__":
    unittest.main()
