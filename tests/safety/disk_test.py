#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Recordings of the head while the disk fills, and while those are killed who write them."""

import hashlib
import os
import signal
import subprocess
import time
import unittest

from head import SMALL, Head, Safety
from harness import wait_until

DISK = 24  # [MB] of a disk of its own
ALONE = ["unshare", "--map-root-user", "--mount"]
MOUNT = """%s sh -c 'mkdir FOLDER/disk && mount -t tmpfs -o size=%dm none FOLDER/disk && exec "$@"' -"""
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
        sizes = self.files()
        digests = {name: (size, self.digest(name, size)) for name, size in sizes.items()}
        self.seen.append((time.monotonic(), digests))

    def lost(self, moment):
        """Files of which something is lost that was there a second before a moment."""
        before = [digests for at, digests in self.seen if at <= moment - 1]
        last = before[-1] if before else {}
        return {name for name, (size, was) in last.items() if self.digest(name, size) != was}

    def is_full(self):
        return os.fstatvfs(self.folder).f_bavail == 0


class Disk(Safety):
    def setUp(self):
        if subprocess.run([*ALONE, "true"], stderr=-3, check=False).returncode != 0:
            self.skipTest("no mount namespaces for this user")
        super().setUp()

    @classmethod
    def setUpClass(cls):
        pass  # each row has heads of its own

    def start(self, *args, **options):
        """A head of its own for a part of a row."""
        head = Head()
        self.addCleanup(head.doCleanups)
        head.begin(*args, is_calibrated=False, **SMALL, **options)
        return head


if __name__ == "__main__":
    unittest.main()
