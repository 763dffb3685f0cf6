# SPDX-License-Identifier: Apache-2.0
"""What a person's device or page does, beside a test: says something again and again."""

import socket
import threading
import time

from harness import wait_until


class Feeder:
    """Does something each `period` seconds until its end, beside the test."""

    def __init__(self, does, period=0.02):
        self.does, self.period, self.is_over = does, period, threading.Event()
        self.pauses = []  # between two times [s]
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        last = time.monotonic()
        while not self.is_over.wait(self.period):
            now = time.monotonic()
            self.pauses.append(now - last)
            last = now
            try:
                self.does(now)
            except OSError:  # what it sends to is gone
                pass

    def end(self):
        self.is_over.set()
        self.thread.join()


class Source:
    """Sends messages to a listening input, also when its module was restarted."""

    def __init__(self, address):
        self.address, self.connection = address, None

    def send(self, data):
        """Whether it is on its way; a reader that closed is connected to again at the next."""
        try:
            if self.connection is None:
                self.connection = socket.socket(socket.AF_UNIX)
                self.connection.settimeout(5)
                self.connection.connect(self.address)
            self.connection.sendall(data)
            return True
        except OSError:
            self.end()
            return False

    def insist(self, data):
        wait_until(lambda: self.send(data))

    def end(self):
        if self.connection:
            self.connection.close()
        self.connection = None
