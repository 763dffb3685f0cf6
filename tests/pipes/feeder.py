# SPDX-License-Identifier: Apache-2.0
"""What a person's device or page does, beside a test: says something again and again."""

import threading
import time


class Feeder:
    """Does something each `period` seconds until its end, beside the test."""

    def __init__(self, does, period=0.02):
        self.does, self.period, self.is_over = does, period, threading.Event()
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        while not self.is_over.wait(self.period):
            try:
                self.does(time.monotonic())
            except OSError:  # what it sends to is gone
                pass

    def end(self):
        self.is_over.set()
        self.thread.join()
