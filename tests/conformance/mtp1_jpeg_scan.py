# SPDX-License-Identifier: Apache-2.0
"""Reads the scans of a JPEG image into coefficients: Huffman codes, sequential and progressive.

Section numbers are of ITU-T T.81.
"""

from itertools import islice

from mtp1_jpeg_fields import JpegError, ceil_div
from mtp1_pixels import ZIGZAG


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
