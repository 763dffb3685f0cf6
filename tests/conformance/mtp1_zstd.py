# SPDX-License-Identifier: Apache-2.0
"""Expands zstd frames, written from RFC 8878: all kinds of blocks and tables, but no dictionaries.

    decompress(data, most) -> bytes

Output is bounded: more than `most` bytes are refused before they are made. Section numbers are of
the RFC. Anything that is not one or more whole frames raises ZstdError.
"""

import struct

from mtp1_entropy import (
    BackwardBits,
    Bytes,
    ZstdError,
    decode_huffman,
    fse_table,
    read_chances,
    read_huffman,
)

MAGIC = 0xFD2FB528
SKIPPABLE = range(0x184D2A50, 0x184D2A60)
MAX_BLOCK = 128 << 10  # bytes; 3.1.1.2.4
MAX_WINDOW_LOG = 31  # a larger window is refused, as the common implementation does

# Number codes of lengths: code -> (base, extra bits); 3.1.1.3.2.1.1
LITERAL_LENGTHS = [(n, 0) for n in range(16)] + list(
    zip(
        (16, 18, 20, 22, 24, 28, 32, 40, 48, 64)
        + (128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768, 65536),
        (1, 1, 1, 1, 2, 2, 3, 3, 4, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16),
    )
)
MATCH_LENGTHS = [(n + 3, 0) for n in range(32)] + list(
    zip(
        (35, 37, 39, 41, 43, 47, 51, 59, 67, 83, 99)
        + (131, 259, 515, 1027, 2051, 4099, 8195, 16387, 32771, 65539),
        (1, 1, 1, 1, 2, 2, 3, 3, 4, 4, 5, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16),
    )
)
OFFSETS = [(1 << n, n) for n in range(32)]

# Default distributions (3.1.1.3.2.2), as (accuracy, chances); -1 is "less than one".
LITERAL_DEFAULT = (
    6,
    [4, 3, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2, 2, 2, 3, 2, 1, 1, 1, 1, 1]
    + [-1] * 4,
)
MATCH_DEFAULT = (6, [1, 4, 3, 2, 2, 2, 2, 2, 2] + [1] * 37 + [-1] * 7)
OFFSET_DEFAULT = (5, [1, 1, 1, 1, 1, 1, 2, 2, 2] + [1] * 15 + [-1] * 5)

# Codes, default distribution and greatest accuracy of the kinds, in the order of the stream.
KINDS = (
    (LITERAL_LENGTHS, LITERAL_DEFAULT, 9),
    (OFFSETS, OFFSET_DEFAULT, 8),
    (MATCH_LENGTHS, MATCH_DEFAULT, 9),
)


def decompress(data, most):
    """The content of one or more frames, one after the other, at most `most` bytes. 3.1"""
    source = Bytes(data)
    out = bytearray()
    if not data:
        raise ZstdError("no zstd frame")
    while source.left:
        magic = source.number(4)
        if magic in SKIPPABLE:  # 3.1.2
            source.take(source.number(4))
        elif magic == MAGIC:
            Frame(source, out, most).read()
        else:
            raise ZstdError(f"no zstd frame begins with {magic:#010x}")
    return bytes(out)


class Frame:
    """What a frame hands from block to block: its window, tables and last three offsets. 3.1.1"""

    def __init__(self, source, out, most):
        self.source, self.out, self.most = source, out, most
        self.start = len(out)  # earlier frames are out of a match's reach
        self.block = MAX_BLOCK
        self.huffman = None
        self.tables = [None, None, None]
        self.offsets = [1, 4, 8]

    def read(self):
        """Appends the content of the frame."""
        content, has_checksum = self.read_header()
        is_last = False
        while not is_last:
            head = self.source.number(3)  # 3.1.1.2
            is_last, kind, size = bool(head & 1), head >> 1 & 3, head >> 3
            self.read_block(kind, size)
        if content is not None and len(self.out) - self.start != content:
            raise ZstdError(f"a frame of {content} bytes holds {len(self.out) - self.start}")
        if has_checksum and self.source.number(4) != xxh64(self.out[self.start :]) & 0xFFFFFFFF:
            raise ZstdError("wrong checksum")

    def read_header(self):
        """Returns the size of the content, None when not given, and whether a checksum follows."""
        head = self.source.number(1)  # 3.1.1.1.1
        content_flag, is_single, dictionary_flag = head >> 6, head >> 5 & 1, head & 3
        if head & 8:
            raise ZstdError("a reserved bit is set")
        if not is_single:
            window = self.source.number(1)  # 3.1.1.1.2
            log = 10 + (window >> 3)
            if log > MAX_WINDOW_LOG:
                raise ZstdError(f"a window of 2^{log} bytes")
            self.block = min(MAX_BLOCK, (1 << log) + ((1 << log) >> 3) * (window & 7))
        if self.source.number((0, 1, 2, 4)[dictionary_flag]):
            raise ZstdError("needs a dictionary")
        size = (is_single, 2, 4, 8)[content_flag]  # 3.1.1.1.4
        content = self.source.number(size) + (256 if size == 2 else 0) if size else None
        if is_single:
            self.block = min(MAX_BLOCK, content)
        if content is not None and content > self.most - self.start:
            raise ZstdError(f"promises more than {self.most} bytes")
        return content, bool(head & 4)

    def read_block(self, kind, size):
        """Appends the content of a block. 3.1.1.2"""
        if size > self.block:
            raise ZstdError(f"a block of {size} bytes, most {self.block}")
        if kind == 0:
            self.append(self.source.take(size))
        elif kind == 1:
            byte = self.source.take(1)
            self.check_room(size)
            self.append(byte * size)
        elif kind == 2:
            self.read_compressed(Bytes(self.source.take(size)))
        else:
            raise ZstdError("a reserved kind of block")

    def check_room(self, count):
        """Refuses more bytes than are wanted."""
        if len(self.out) + count > self.most:
            raise ZstdError(f"holds more than {self.most} bytes")

    def append(self, some):
        """Appends bytes to the output."""
        self.check_room(len(some))
        self.out += some

    def read_compressed(self, block):
        """Appends the content of a compressed block. 3.1.1.3"""
        begin = len(self.out)
        literals = self.read_literals(block)
        count = self.read_count(block)
        used = 0
        if count:
            self.read_tables(block)
            for length, offset, match in self.sequences(block, count):
                if used + length > len(literals):
                    raise ZstdError("a sequence wants more literals than there are")
                if len(self.out) - begin + length + match > self.block:
                    raise ZstdError(f"a block holds more than {self.block} bytes")
                self.append(literals[used : used + length])
                used += length
                self.copy(offset, match)
        elif block.left:
            raise ZstdError("bytes behind a block without sequences")
        self.append(literals[used:])
        if len(self.out) - begin > self.block:
            raise ZstdError(f"a block holds more than {self.block} bytes")

    def copy(self, offset, count):
        """Appends `count` bytes that stand `offset` back; the two may overlap."""
        if offset > len(self.out) - self.start:
            raise ZstdError(f"offset {offset} is before the frame")
        self.check_room(count)
        begin = len(self.out) - offset
        some = self.out[begin : begin + count]
        self.out += (some * (count // len(some) + 1))[:count]

    def read_literals(self, block):
        """The literals of a block. 3.1.1.3.1"""
        head = block.number(1)
        kind, form = head & 3, head >> 2 & 3
        if kind < 2:  # raw, or one byte again and again
            extra = (0, 1, 0, 2)[form]
            size = (head | block.number(extra) << 8) >> (4 if extra else 3)
            self.check_literals(size)
            return block.take(size) if kind == 0 else block.take(1) * size
        bits = (10, 10, 14, 18)[form]
        sizes = (head | block.number((2, 2, 3, 4)[form]) << 8) >> 4
        size, packed = sizes & (1 << bits) - 1, sizes >> bits
        self.check_literals(size)
        part = Bytes(block.take(packed))
        if kind == 2:
            self.huffman = read_huffman(part)
        if self.huffman is None:
            raise ZstdError("no Huffman table to use again")
        return self.read_streams(part, size, 1 if form == 0 else 4)

    def check_literals(self, size):
        """Refuses more literals than a block can hold."""
        if size > self.block:
            raise ZstdError(f"{size} literals in a block of {self.block} bytes")

    def read_streams(self, part, size, count):
        """Literals in one Huffman stream, or in four. 3.1.1.3.1.6"""
        if count == 1:
            return decode_huffman(part.take(part.left), self.huffman, size)
        if size < 6:
            raise ZstdError("four streams for less than six literals")
        jumps = [part.number(2) for _ in range(3)]
        streams = [part.take(jump) for jump in jumps] + [part.take(part.left)]
        each = (size + 3) // 4
        wanted = (each, each, each, size - 3 * each)
        return b"".join(decode_huffman(s, self.huffman, n) for s, n in zip(streams, wanted))

    def read_count(self, block):
        """How many sequences follow. 3.1.1.3.2.1"""
        first = block.number(1)
        if first < 128:
            return first
        if first < 255:
            return (first - 128 << 8) + block.number(1)
        return block.number(2) + 0x7F00

    def read_tables(self, block):
        """Sets the tables of the three kinds of codes. 3.1.1.3.2.1"""
        modes = block.number(1)
        if modes & 3:
            raise ZstdError("a reserved bit of the modes is set")
        for index, (codes, default, max_accuracy) in enumerate(KINDS):
            mode = modes >> (6 - 2 * index) & 3
            if mode == 0:
                self.tables[index] = fse_table(*default)
            elif mode == 1:
                self.tables[index] = (0, [(check_code(block.number(1), codes), 0, 0)])
            elif mode == 2:
                accuracy, chances = read_chances(block, max_accuracy)
                check_code(len(chances) - 1, codes)
                self.tables[index] = fse_table(accuracy, chances)
            elif self.tables[index] is None:
                raise ZstdError("no table to use again")

    def sequences(self, block, count):
        """Yields literal length, offset and match length of each sequence. 3.1.1.3.2.1.2"""
        bits = BackwardBits(block.take(block.left))
        literal, offset, match = self.tables
        states = [bits.take(accuracy) for accuracy, _ in (literal, offset, match)]
        for index in range(count):
            literal_entry = literal[1][states[0]]
            offset_entry = offset[1][states[1]]
            match_entry = match[1][states[2]]
            value = (1 << offset_entry[0]) + bits.take(offset_entry[0])
            base, extra = MATCH_LENGTHS[match_entry[0]]
            match_length = base + bits.take(extra)
            base, extra = LITERAL_LENGTHS[literal_entry[0]]
            literal_length = base + bits.take(extra)
            yield literal_length, self.next_offset(value, literal_length), match_length
            if index + 1 < count:  # the order of updates: literals, matches, offsets
                states[0] = literal_entry[2] + bits.take(literal_entry[1])
                states[2] = match_entry[2] + bits.take(match_entry[1])
                states[1] = offset_entry[2] + bits.take(offset_entry[1])
        if bits.left:
            raise ZstdError("bits are left behind the sequences")

    def next_offset(self, value, literal_length):
        """The offset that a value means: a new one, or one of the last three. 3.1.1.5"""
        last = self.offsets
        if value > 3:
            self.offsets = [value - 3, last[0], last[1]]
            return value - 3
        index = value - 1 + (literal_length == 0)
        offset = last[index] if index < 3 else last[0] - 1
        if offset == 0:
            raise ZstdError("offset 0")
        self.offsets = [offset] + last[: min(index, 2)] + last[min(index, 2) + 1 :]
        return offset


def check_code(code, codes):
    """A code of lengths or offsets; refused when its kind has no such code."""
    if code >= len(codes):
        raise ZstdError(f"no code {code}")
    return code


MASK = (1 << 64) - 1
PRIMES = (
    0x9E3779B185EBCA87,
    0xC2B2AE3D27D4EB4F,
    0x165667B19E3779F9,
    0x85EBCA77C2B2AE63,
    0x27D4EB2F165667C5,
)


def xxh64(data):
    """XXH64 of bytes, seed 0. Source: xxHash specification 0.1.1, XXH64 algorithm description."""
    p1, p2, p3, p4, p5 = PRIMES
    stripes = len(data) // 32
    if stripes:
        lanes = [p1 + p2 & MASK, p2, 0, -p1 & MASK]
        for stripe in struct.iter_unpack("<4Q", data[: 32 * stripes]):
            lanes = [round64(lane, word) for lane, word in zip(lanes, stripe)]
        value = sum(rotate(lane, turn) for lane, turn in zip(lanes, (1, 7, 12, 18))) & MASK
        for lane in lanes:
            value = (value ^ round64(0, lane)) * p1 + p4 & MASK
    else:
        value = p5
    value = value + len(data) & MASK
    at = 32 * stripes
    while at + 8 <= len(data):
        word = int.from_bytes(data[at : at + 8], "little")
        value = rotate(value ^ round64(0, word), 27) * p1 + p4 & MASK
        at += 8
    if at + 4 <= len(data):
        word = int.from_bytes(data[at : at + 4], "little")
        value = rotate(value ^ word * p1 & MASK, 23) * p2 + p3 & MASK
        at += 4
    for byte in data[at:]:
        value = rotate(value ^ byte * p5 & MASK, 11) * p1 & MASK
    value = (value ^ value >> 33) * p2 & MASK
    value = (value ^ value >> 29) * p3 & MASK
    return value ^ value >> 32


def round64(lane, word):
    """One step of a lane."""
    return rotate(lane + word * PRIMES[1] & MASK, 31) * PRIMES[0] & MASK


def rotate(value, count):
    """64 bits turned to the left."""
    return (value << count | value >> 64 - count) & MASK
