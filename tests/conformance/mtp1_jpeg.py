# SPDX-License-Identifier: Apache-2.0
"""Decodes a JPEG image, written from ITU-T T.81: sequential or progressive, 8 bits, Huffman codes.

    decode(data, width, height, components) -> bytes, row by row, components next to one another

One component, or three: JFIF's YCbCr or RGB, given as r g b. Section numbers are of T.81. Anything
that is not just one whole image of the wanted shape raises JpegError.
"""

import re
from array import array

from mtp1_jpeg_fields import Fields, JpegError, ceil_div
from mtp1_jpeg_scan import Scan, read_huffman
from mtp1_pixels import interleave, plane, to_rgb, upsample

# Markers of segments: frames, tables, scans, applications' own, comments. Table B.1
SEGMENTS = {0xC0, 0xC1, 0xC2, 0xC4, 0xDA, 0xDB, 0xDD, *range(0xE0, 0xF0), 0xFE}
MARKER = re.compile(rb"\xff+([\x01-\xfe])")
STUFFED = re.compile(rb"\xff+\x00")


def decode(data, width, height, components):
    """The samples of an image that must be of just this shape."""
    try:
        image = Image(data, width, height, components)
        image.read()
        return image.samples()
    except OverflowError:  # of an array("h")
        raise JpegError("a coefficient is out of range") from None


class Component:
    """What a frame header says of one component, and its coefficients. B.2.2"""

    def __init__(self, name, h, v, quantizer):
        self.name, self.h, self.v, self.quantizer = name, h, v, quantizer
        self.table = None  # the quantization table, fixed by the component's first scan
        self.known = [None] * 64  # of each coefficient, the lowest bit that came

    def set_size(self, frame):
        """Finds out how many samples and blocks there are. A.1.1, A.2.4"""
        self.width = ceil_div(frame.width * self.h, frame.h)
        self.height = ceil_div(frame.height * self.v, frame.v)
        self.columns, self.rows = ceil_div(self.width, 8), ceil_div(self.height, 8)
        self.stride = frame.mcu_columns * self.h  # blocks in a row, with those that only fill MCUs
        self.blocks = self.stride * frame.mcu_rows * self.v


class Image:
    """An image as it is read: tables, components and their coefficients."""

    def __init__(self, data, width, height, components):
        self.data, self.width, self.height, self.wanted = data, width, height, components
        self.at = 0
        self.quantizers, self.dc, self.ac = {}, {}, {}
        self.components = []
        self.interval = 0
        self.has_jfif, self.adobe, self.is_progressive = False, None, False

    def take(self, count):
        """The next `count` bytes."""
        if count > len(self.data) - self.at:
            raise JpegError("cut short")
        self.at += count
        return self.data[self.at - count : self.at]

    def segment(self):
        """The parameters of a marker segment."""
        size = int.from_bytes(self.take(2), "big")
        if size < 2:
            raise JpegError(f"a segment of {size} bytes")
        return Fields(self.take(size - 2))

    def read(self):
        """Reads from the first marker to the last. B.2"""
        if self.take(2) != b"\xff\xd8":
            raise JpegError("does not begin as a JPEG")
        while True:
            found = MARKER.match(self.data, self.at)
            if not found:
                raise JpegError("cut short" if self.at == len(self.data) else "no marker")
            self.at = found.end()
            marker = found[1][0]
            if marker == 0xD9:
                break
            if marker not in SEGMENTS:
                raise JpegError(
                    f"marker {marker:#04x} is neither sequential nor progressive Huffman"
                )
            self.read_segment(marker, self.segment())
        if self.at != len(self.data):
            raise JpegError("bytes behind the image")
        if not self.components or any(part.known[0] is None for part in self.components):
            raise JpegError("a component is missing")

    def read_segment(self, marker, fields):
        """Reads the segment of one marker. Table B.1"""
        if marker in (0xC0, 0xC1, 0xC2):
            self.is_progressive = marker == 0xC2
            self.read_frame(fields)
        elif marker == 0xC4:
            while fields.left:
                head = fields.number(1)
                if head >> 4 > 1 or head & 15 > 3:
                    raise JpegError("no such Huffman table")
                table = read_huffman(fields, most=255 if head >> 4 else 11)
                (self.ac if head >> 4 else self.dc)[head & 15] = table
        elif marker == 0xDB:
            while fields.left:
                head = fields.number(1)
                if head >> 4 > 1 or head & 15 > 3:
                    raise JpegError("no such quantization table")
                self.quantizers[head & 15] = [fields.number(1 + (head >> 4)) for _ in range(64)]
        elif marker == 0xDD:
            self.interval = fields.number(2)
            fields.end()
        elif marker == 0xDA:
            self.read_scan(fields)
        elif marker == 0xE0:
            self.has_jfif = self.has_jfif or fields.data.startswith(b"JFIF\0")
        elif marker == 0xEE and fields.data.startswith(b"Adobe") and fields.left >= 12:
            self.adobe = fields.data[11]

    def read_frame(self, fields):
        """Reads a frame header. B.2.2"""
        if self.components:
            raise JpegError("two frames")
        if fields.number(1) != 8:
            raise JpegError("not of 8 bits")
        height, width, count = fields.number(2), fields.number(2), fields.number(1)
        if (width, height, count) != (self.width, self.height, self.wanted):
            wanted = f"{self.width}x{self.height} of {self.wanted}"
            raise JpegError(f"an image {width}x{height} of {count} components, not {wanted}")
        for _ in range(count):
            name, factors, quantizer = (fields.number(1) for _ in range(3))
            if not (1 <= factors >> 4 <= 4 and 1 <= factors & 15 <= 4):
                raise JpegError("no such sampling")
            self.components.append(Component(name, factors >> 4, factors & 15, quantizer))
        fields.end()
        if len({part.name for part in self.components}) < count:
            raise JpegError("two components of one name")
        self.h = max(part.h for part in self.components)
        self.v = max(part.v for part in self.components)
        self.mcu_columns = ceil_div(self.width, 8 * self.h)
        self.mcu_rows = ceil_div(self.height, 8 * self.v)
        for part in self.components:
            part.set_size(self)
            if part.columns * part.rows > 8 * len(self.data):  # a block takes a bit at least
                raise JpegError("cut short")
            part.coefficients = array("h", bytes(128 * part.blocks))

    def read_scan(self, fields):
        """Reads a scan header and the scan. B.2.3"""
        parts = []
        for _ in range(fields.number(1)):
            name, tables = fields.number(1), fields.number(1)
            found = [part for part in self.components if part.name == name]
            if not found or found[0] in parts:
                raise JpegError("a scan of no such component")
            found[0].dc, found[0].ac = self.dc.get(tables >> 4), self.ac.get(tables & 15)
            parts += found
        start, end, bits = fields.number(1), fields.number(1), fields.number(1)
        fields.end()
        scan = Scan(self, parts, start, end, bits >> 4, bits & 15)
        for part in parts:
            if part.table is None:
                if part.quantizer not in self.quantizers:
                    raise JpegError("no such quantization table")
                part.table = self.quantizers[part.quantizer]
        scan.read(self.entropy_coded())

    def entropy_coded(self):
        """The bytes up to the next marker, in their restart intervals. B.1.1.5, F.1.2.3"""
        parts = []
        while True:
            found = MARKER.search(self.data, self.at)
            if not found:
                raise JpegError("cut short")
            parts.append(STUFFED.sub(b"\xff", self.data[self.at : found.start()]))
            if not 0xD0 <= found[1][0] <= 0xD7:
                self.at = found.start()
                return parts
            if found[1][0] != 0xD0 + (len(parts) - 1) % 8:
                raise JpegError("restarts are out of order")
            self.at = found.end()

    def samples(self):
        """The whole image."""
        planes = [plane(part) for part in self.components]
        if len(planes) == 1:
            return b"".join(planes[0])
        parts = zip(self.components, planes)
        full = [upsample(rows, part, self) for part, rows in parts]
        if self.is_rgb():
            return b"".join(interleave(row) for row in zip(*full))
        return b"".join(interleave(to_rgb(*row)) for row in zip(*full))

    def is_rgb(self):
        """Whether the image says that it is RGB: by Adobe's segment, or else by its names."""
        if self.has_jfif:
            return False
        if self.adobe is not None:
            return self.adobe == 0
        return bytes(part.name for part in self.components) == b"RGB"
