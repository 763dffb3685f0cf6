# SPDX-License-Identifier: Apache-2.0
"""The numbers of a JPEG's marker segments, and what is wrong with a JPEG."""


class JpegError(ValueError):
    """Why bytes are not the wanted image."""


class Fields:
    """The numbers of a marker segment."""

    def __init__(self, data):
        self.data, self.at = data, 0

    @property
    def left(self):
        """How many bytes are left."""
        return len(self.data) - self.at

    def number(self, count):
        """The next `count` bytes as a number."""
        if count > self.left:
            raise JpegError("a segment is cut short")
        self.at += count
        return int.from_bytes(self.data[self.at - count : self.at], "big")

    def end(self):
        """Refuses more numbers than there should be."""
        if self.left:
            raise JpegError("a segment is too long")


def ceil_div(number, divisor):
    """The quotient, rounded up."""
    return -(-number // divisor)
