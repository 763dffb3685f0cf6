# SPDX-License-Identifier: Apache-2.0
"""Decodes a JPEG picture, written from ITU-T T.81: sequential or progressive, 8 bits, Huffman codes.

    decode(data, width, height, components) -> bytes, row by row, components next to one another

One component, or three: JFIF's YCbCr or RGB, given as r g b. Section numbers are of T.81. Anything
that is not just one whole picture of the wanted shape raises JpegError.
"""

import re
from array import array
from itertools import islice

from mtp1_pixels import ZIGZAG, interleave, plane, to_rgb, upsample

# Markers of segments: frames, tables, scans, applications' own, comments. Table B.1
SEGMENTS = {0xC0, 0xC1, 0xC2, 0xC4, 0xDA, 0xDB, 0xDD, *range(0xE0, 0xF0), 0xFE}
MARKER = re.compile(rb"\xff+([\x01-\xfe])")
STUFFED = re.compile(rb"\xff+\x00")


class JpegError(ValueError):
    """Why bytes are not the wanted picture."""


def decode(data, width, height, components):
    """The samples of a picture that must be of just this shape."""
    try:
        picture = Picture(data, width, height, components)
        picture.read()
        return picture.samples()
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


class Picture:
    """A picture as it is read: tables, components and their coefficients."""

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
            raise JpegError("bytes behind the picture")
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
            raise JpegError(f"a picture {width}x{height} of {count} components, not {wanted}")
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
        """The whole picture."""
        planes = [plane(part) for part in self.components]
        if len(planes) == 1:
            return b"".join(planes[0])
        parts = zip(self.components, planes)
        full = [upsample(rows, part, self) for part, rows in parts]
        if self.is_rgb():
            return b"".join(interleave(row) for row in zip(*full))
        return b"".join(interleave(to_rgb(*row)) for row in zip(*full))

    def is_rgb(self):
        """Whether the picture says that it is RGB: by Adobe's segment, or else by its names."""
        if self.has_jfif:
            return False
        if self.adobe is not None:
            return self.adobe == 0
        return bytes(part.name for part in self.components) == b"RGB"


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


# ------------------------------------------------------------------------------------------ scans


def read_huffman(fields, most):
    """For every value of 16 bits the symbol and the bits of its code. C.2; B.2.4.2

    Symbols are at most `most`: a first coefficient of 8-bit samples differs by 11 bits (table F.1).
    """
    counts = [fields.number(1) for _ in range(16)]
    table = []
    for length, count in enumerate(counts, 1):
        for _ in range(count):
            symbol = fields.number(1)
            if symbol > most:
                raise JpegError("a difference of too many bits")
            table += [(symbol, length)] * (1 << 16 - length)
    if len(table) >= 1 << 16:  # all ones are no code
        raise JpegError("too many Huffman codes")
    return table + [(None, 0)] * ((1 << 16) - len(table))


class Bits:
    """Bits of an entropy-coded segment, from the first byte's highest on. F.2.2.5"""

    def __init__(self, data):
        self.data, self.at = data + bytes(4), 0
        self.end = 8 * len(data)

    def take(self, count):
        """The next `count` (0 to 16) bits as a number."""
        some = int.from_bytes(self.data[self.at >> 3 : (self.at >> 3) + 4], "big")
        value = some >> 32 - count - (self.at & 7) & (1 << count) - 1
        self.at += count
        if self.at > self.end:
            raise JpegError("a scan is cut short")
        return value

    def symbol(self, table):
        """The next symbol. F.2.2.3"""
        some = int.from_bytes(self.data[self.at >> 3 : (self.at >> 3) + 4], "big")
        symbol, length = table[some >> 16 - (self.at & 7) & 0xFFFF]
        self.at += length
        if symbol is None or self.at > self.end:
            raise JpegError("a scan is damaged or cut short")
        return symbol

    def signed(self, count):
        """The next number of `count` bits, of either sign. F.2.2.1"""
        value = self.take(count)
        return value if not count or value >> count - 1 else value + 1 - (1 << count)


class Scan:
    """One scan: which coefficients, and which of their bits, of which components. G.1"""

    def __init__(self, frame, parts, start, end, high, low):
        self.frame, self.parts = frame, parts
        self.start, self.end, self.high, self.low = start, end, high, low
        if frame.is_progressive:
            self.check_progressive()
            self.block = (
                (self.dc_refine if high else self.dc_first)
                if start == 0
                else (self.ac_refine if high else self.ac_first)
            )
        else:
            if (start, end, high, low) != (0, 63, 0, 0):
                raise JpegError("a baseline scan of some coefficients")
            self.block = self.sequential
        if not 1 <= len(parts) <= 4 or (len(parts) > 1 and sum(p.h * p.v for p in parts) > 10):
            raise JpegError("a scan of too few or too many blocks")
        self.check_tables()
        self.note_what_comes()

    def check_progressive(self):
        """Refuses what no progressive scan may be. G.1.1.1"""
        is_dc = self.start == 0 and self.end == 0
        is_ac = 1 <= self.start <= self.end <= 63 and len(self.parts) == 1
        if not (is_dc or is_ac) or self.low > 13 or (self.high and self.low != self.high - 1):
            raise JpegError("no such progressive scan")

    def check_tables(self):
        """Refuses a scan whose Huffman tables did not come."""
        for part in self.parts:
            wants_dc = self.start == 0 and not self.high
            if (wants_dc and not part.dc) or (self.end > 0 and not part.ac):
                raise JpegError("no such Huffman table")

    def note_what_comes(self):
        """Refuses bits out of their order: each coefficient from its high bits to its low ones."""
        for part in self.parts:
            if self.start and part.known[0] is None:
                raise JpegError("scans are out of order")
            for index in range(self.start, self.end + 1):
                if part.known[index] != (self.high or None):
                    raise JpegError("scans are out of order")
                part.known[index] = self.low

    def read(self, intervals):
        """Reads all blocks in the scan's order. A.2, E.2.4"""
        units, interval = self.units(), self.frame.interval
        wanted = ceil_div(self.count_units(), interval) if interval else 1
        if len(intervals) != wanted:
            raise JpegError(f"{len(intervals)} restart intervals, not {wanted}")
        for data in intervals:
            bits = Bits(data)
            self.run = 0  # blocks still to come without new coefficients
            for part in self.parts:
                part.last_dc = 0
            for unit in islice(units, interval or None):
                for part, block in unit:
                    self.block(bits, part, part.coefficients, 64 * block)
            if self.run or bits.end - bits.at > 7:
                raise JpegError("a scan has bytes to spare")

    def count_units(self):
        """How many minimum coded units there are."""
        if len(self.parts) == 1:
            return self.parts[0].rows * self.parts[0].columns
        return self.frame.mcu_rows * self.frame.mcu_columns

    def units(self):
        """Yields the minimum coded units, each the (component, block) pairs in it. A.2"""
        if len(self.parts) == 1:
            part = self.parts[0]
            for row in range(part.rows):
                for column in range(part.columns):
                    yield ((part, row * part.stride + column),)
            return
        for top in range(self.frame.mcu_rows):
            for left in range(self.frame.mcu_columns):
                yield [
                    (part, (top * part.v + y) * part.stride + left * part.h + x)
                    for part in self.parts
                    for y in range(part.v)
                    for x in range(part.h)
                ]

    def sequential(self, bits, part, out, at):
        """A whole block. F.2.2"""
        part.last_dc += bits.signed(bits.symbol(part.dc))
        out[at] = part.last_dc
        index = 1
        while index < 64:
            symbol = bits.symbol(part.ac)
            run, size = symbol >> 4, symbol & 15
            if size == 0 and run != 15:
                return
            index += run
            if index > 63:
                raise JpegError("a block is too long")
            if size:
                out[at + ZIGZAG[index]] = bits.signed(size)
            index += 1

    def dc_first(self, bits, part, out, at):
        """The high bits of a block's first coefficient. G.1.2.1"""
        part.last_dc += bits.signed(bits.symbol(part.dc))
        out[at] = part.last_dc << self.low

    def dc_refine(self, bits, part, out, at):
        """One more bit of a block's first coefficient. G.1.2.1"""
        out[at] |= bits.take(1) << self.low

    def ac_first(self, bits, part, out, at):
        """The high bits of a band of coefficients. G.1.2.2"""
        if self.run:
            self.run -= 1
            return
        index = self.start
        while index <= self.end:
            symbol = bits.symbol(part.ac)
            run, size = symbol >> 4, symbol & 15
            if size == 0 and run != 15:
                self.run = (1 << run) - 1 + bits.take(run)
                return
            index += run
            if index > self.end:
                raise JpegError("a block is too long")
            if size:
                out[at + ZIGZAG[index]] = bits.signed(size) << self.low
            index += 1

    def ac_refine(self, bits, part, out, at):
        """One more bit of a band of coefficients, and new ones among the zeros. G.1.2.3"""
        index = self.start
        while index <= self.end and not self.run:
            symbol = bits.symbol(part.ac)
            run, size = symbol >> 4, symbol & 15
            if size > 1:
                raise JpegError("a new coefficient of more than one bit")
            if size == 0 and run != 15:
                self.run = (1 << run) + bits.take(run)
                break
            new = (1 if bits.take(1) else -1) << self.low if size else 0
            index = self.refine(bits, out, at, index, run)
            if index > self.end:
                raise JpegError("a block is too long")
            out[at + ZIGZAG[index]] = new
            index += 1
        if self.run:
            self.refine(bits, out, at, index, 64)
            self.run -= 1

    def refine(self, bits, out, at, index, zeros):
        """Reads a bit for each coefficient that is not zero, until so many zeros are passed."""
        while index <= self.end:
            place = at + ZIGZAG[index]
            if out[place]:
                if bits.take(1):
                    out[place] += (1 if out[place] > 0 else -1) << self.low
            elif not zeros:
                break
            else:
                zeros -= 1
            index += 1
        return index
