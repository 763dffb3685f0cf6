# SPDX-License-Identifier: Apache-2.0
"""What the tests of devices between the robot and a person share."""

import array
import math
import os
import signal
import wave

from harness import WATCHDOG, Pipes, wait_until


def tone(rate, seconds, channels=1, hertz=440):
    """A tone as samples of i16, the same in all channels."""
    samples = array.array("h")
    for i in range(int(rate * seconds)):
        samples.extend([int(8000 * math.sin(2 * math.pi * hertz * i / rate))] * channels)
    return samples


def loudness(samples):
    return sum(map(abs, samples)) / max(1, len(samples))


class Bodies(Pipes):
    """Programs that run, what they say, and what they have written so far."""

    def run_module(self, command):
        """Starts a module that says its lines into a file."""
        return self.start("exec " + command + " 2>said", stdout=-3)

    def said(self):
        return self.read("said")

    def wait_for(self, line, times=1):
        """Waits until a line has been said so often."""
        wait_until(lambda: self.said().count(line) >= times)

    def stop(self, process, status=0):
        os.killpg(process.pid, signal.SIGTERM)
        self.assertEqual(process.wait(timeout=WATCHDOG), status, self.said())

    def write_wav(self, name, samples, rate, channels=1):
        with wave.open(self.path(name), "wb") as file:
            file.setnchannels(channels)
            file.setsampwidth(2)
            file.setframerate(rate)
            file.writeframes(samples.tobytes())

    def read_wav(self, name):
        """Rate, channels and samples of a file that is whole."""
        with wave.open(self.path(name), "rb") as file:
            data = file.readframes(file.getnframes())
            return file.getframerate(), file.getnchannels(), array.array("h", data)
