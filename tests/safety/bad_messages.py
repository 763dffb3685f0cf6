# SPDX-License-Identifier: Apache-2.0
"""Bad messages for an input, by its types as `--describe` says them: 20 kinds, see KINDS."""

import struct

TYPES = (
    "position rotation rgb_image intensity_image vector_field string transformation dense_graph "
    "sparse_graph sound map table"
).split()
SCALARS = "u8 i8 u16 i16 u32 i32 u64 i64 f32 f64".split()
BYTES = 1, 1, 2, 2, 4, 4, 8, 8, 4, 8
TEXT, BINARY, ZSTD, JPEG = range(4)


def info(kind, encoding):
    scalar = SCALARS.index(kind["scalar"])
    type_number = TYPES.index(kind["type"]) + 1
    return type_number * 10000 + kind["components"] * 100 + scalar * 10 + encoding


def header(number, width, height, coord=0, mode=0, version=1, ttl=8):
    return b"%d 91 0 0 %d 0 %d %d %d %d %d\n" % (version, ttl, number, mode, coord, width, height)


class Bad:
    """The kinds for one input."""

    def __init__(self, types, mode):
        self.kind = types[0] if types else {"type": "table", "components": 1, "scalar": "f64"}
        self.width = self.kind.get("width") or 2
        self.height = self.kind.get("height") or 2
        self.coord = self.kind.get("coord") or 0
        self.mode = mode
        self.count = self.width * self.height * self.kind["components"]
        self.size = self.count * BYTES[SCALARS.index(self.kind["scalar"])]
        self.is_string = self.kind["type"] == "string"

    def of(self, encoding, elements, width=None, height=None, coord=None):
        width, height = width or self.width, height or self.height
        coord = self.coord if coord is None else coord
        return header(info(self.kind, encoding), width, height, coord, self.mode) + elements + b"\n"

    def text(self, word):
        """All numbers are this one; of a string, as many bytes."""
        if self.is_string:
            return self.of(TEXT, (word * self.count)[: self.size].ljust(self.size))
        row = b" ".join([word] * (self.width * self.kind["components"]))
        return self.of(TEXT, b"\n".join([row] * self.height))

    def compressed(self, encoding, elements, *sides):
        return self.of(encoding, b"%d\n%s" % (len(elements), elements), *sides)

    # Each ends the connection (a peer that has lost its place), or is one message that is dropped.

    def garbage(self):
        return bytes(range(255, 0, -1)) * 4

    def header_too_long(self):
        return b"1 " * 200

    def header_cut(self):
        return b"1 91 0\n"

    def header_of_letters(self):
        return b"a b c d e f g h i j k\n"

    def wrong_version(self):
        return header(120190, 1, 1, version=2) + b"1\n"

    def negative_side(self):
        return header(120190, -1, 1) + b"1\n"

    def huge_side(self):
        return header(info(self.kind, BINARY), 2**31 - 1, 2**31 - 1) + b"1\n"

    def promised_and_cut(self):
        return header(40101, 10000, 10000) + b"x" * 100  # 100 MB that do not come

    def wrong_end(self):
        return self.of(BINARY, b"x" * self.size)[:-1] + b"x"

    def not_a_number(self):
        return self.text(b"nan")

    def infinite(self):
        return self.text(b"-inf")

    def letters(self):
        return self.text(b"1x")

    def other_type(self):
        other = {"type": "sound", "components": 3, "scalar": "u16"}
        return header(info(other, BINARY), 7, 1, 21, self.mode) + b"x" * 42 + b"\n"

    def wrong_shape(self):
        return self.of(BINARY, b"\x01" * self.size * 25, self.width * 5, self.height * 5)

    def wrong_coord(self):
        return self.of(BINARY, b"\0" * self.size, coord=999)

    def empty(self):
        return header(info(self.kind, BINARY), 0, 0, self.coord, self.mode) + b"\n"

    def random_bits(self):
        return self.of(BINARY, (b"\xff\x7f\x12\x80\x01" * self.size)[: self.size])

    def bad_jpeg(self):
        jpeg = b"\xff\xd8\xff\xe0" + b"\x13" * 32
        number = info({"type": "rgb_image", "components": 3, "scalar": "u8"}, JPEG)
        return header(number, 800, 600, 7, self.mode) + b"%d\n%s\n" % (len(jpeg), jpeg)

    def bad_zstd(self):
        return self.compressed(ZSTD, b"\x28\xb5\x2f\xfd" + b"\x77" * 40)

    def much_of_little(self):
        """8 kB of zstd that are 250 MB: blocks of 128 kB, each of one byte that is repeated."""
        element = self.kind["components"] * BYTES[SCALARS.index(self.kind["scalar"])]
        height = 1900 // element
        block = lambda is_last: struct.pack("<I", 131072 << 3 | 1 << 1 | is_last)[:3] + b"\0"
        blocks = block(0) * (height * element - 1) + block(1)
        return self.compressed(ZSTD, b"\x28\xb5\x2f\xfd\x00\x58" + blocks, 131072, height)


KINDS = (
    "garbage header_too_long header_cut header_of_letters wrong_version negative_side huge_side "
    "promised_and_cut wrong_end not_a_number infinite letters other_type wrong_shape wrong_coord "
    "empty random_bits bad_jpeg bad_zstd much_of_little"
).split()
CLOSES = KINDS[:9] + ["letters"]  # after which the peer connects again


def bad_messages(types, mode):
    """By kind."""
    bad = Bad(types, mode)
    return {kind: getattr(bad, kind)() for kind in KINDS}
