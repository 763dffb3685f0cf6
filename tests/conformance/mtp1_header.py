# SPDX-License-Identifier: Apache-2.0
"""The header of MTP/1, the message that it begins, and what a reader refuses in it (R4 to R24)."""

import re
from dataclasses import dataclass
from typing import Optional

from mtp1_number import CODES, FLOATS, INTEGER, SCALARS

I31 = 2**31 - 1
I63 = 2**63 - 1

# name, least and greatest value of each header field; R6 is the rule of the first, R16 of the last.
FIELDS = (
    ("version", 1, 1),
    ("src", 0, I31),
    ("dst", -(2**31), I31),
    ("seq", 0, I63),
    ("ttl", 0, 255),
    ("time", 0, I63),
    ("info", 0, I31),
    ("mode", 0, I31),
    ("coord", 0, I31),
    ("width", 0, I31),
    ("height", 0, I31),
)

# Matrix types: TT -> name, components, scalars (section 3).
ANY = range(1, 100)
TYPES = {
    1: ("position", (3, 6, 9), FLOATS),
    2: ("rotation", (3, 6, 9), FLOATS),
    3: ("rgb_image", (3, 4), ("u8", "u16") + FLOATS),
    4: ("intensity_image", (1,), SCALARS),
    5: ("vector_field", ANY, SCALARS),
    6: ("string", (1,), ("u8",)),
    7: ("transformation", (1,), FLOATS),
    8: ("dense_graph", ANY, SCALARS),
    9: ("sparse_graph", range(2, 100), SCALARS),
    10: ("sound", ANY, SCALARS),
    11: ("map", ANY, SCALARS),
    12: ("table", ANY, SCALARS),
}
ENCODINGS = ("text", "binary", "zstd", "jpeg")
MAX_JPEG_SIDE = 65500  # R21


class Refused(Exception):
    """What a reader says of a message that breaks a rule.

    rule      its name, "R7"
    field     the header field, or "header", "elements", "length", "stream"
    byte      distance from the start of the stream
    reason    a few words for a person
    messages  whole messages that came before
    """

    def __init__(self, rule, field, byte, reason):
        super().__init__(rule, field, byte, reason)
        self.rule, self.field, self.byte, self.reason = rule, field, byte, reason
        self.messages = 0

    def reported(self):
        """What the twin of a vector says (section 8)."""
        return {name: getattr(self, name) for name in ("rule", "field", "byte", "messages")}

    def __str__(self):
        place = f"{self.rule} {self.field} byte {self.byte}"
        return f"{place}: {self.reason} (after {self.messages} messages)"


@dataclass
class Header:
    """The eleven integers, in the order of the line (section 2)."""

    version: int = 1
    src: int = 0
    dst: int = 0
    seq: int = 0
    ttl: int = 8
    time: int = 0
    info: int = 0
    mode: int = 0
    coord: int = 0
    width: int = 0
    height: int = 0

    @property
    def type(self):
        """Name of the matrix type."""
        return TYPES[self.info // 10000][0]

    @property
    def components(self):
        """Numbers in an element."""
        return self.info // 100 % 100

    @property
    def scalar(self):
        """Name of the type of a number."""
        return SCALARS[self.info // 10 % 10]

    @property
    def code(self):
        """struct.Struct of one number."""
        return CODES[self.info // 10 % 10]

    @property
    def encoding(self):
        """Name of the encoding."""
        return ENCODINGS[self.info % 10]

    @property
    def row(self):
        """Numbers in a row."""
        return self.width * self.components

    @property
    def size(self):
        """Bytes of the binary form."""
        return self.row * self.height * self.code.size


@dataclass
class Message:
    """One message.

    elements    the binary form (R33) whatever the encoding, so that every float keeps its bits;
                None where compressed elements were not expanded
    compressed  the compressed bytes as they came, in encodings zstd and jpeg
    """

    header: Header
    elements: Optional[bytes] = b""
    compressed: bytes = b""

    def numbers(self):
        """The elements as a flat list of int or float."""
        return [number for (number,) in self.header.code.iter_unpack(self.elements)]


def judge_header(line, start, limit):
    """Makes a header of a line without its line feed that stands at `start`. R4 to R24."""
    line = line[:-1] if line.endswith(b"\r") else line
    words = [(start + found.start(), found[0]) for found in re.finditer(rb"[^ ]+", line)]
    header = Header()
    for index, (field, least, greatest) in enumerate(FIELDS):
        if index == len(words):
            raise Refused("R4", field, start + len(line), "the line ends before this field")
        byte, word = words[index]
        if not INTEGER.fullmatch(word):
            raise Refused("R5", field, byte, f"{show(word)} is not an integer")
        if not least <= int(word) <= greatest:
            raise Refused(f"R{6 + index}", field, byte, f"{show(word)} is out of range")
        setattr(header, field, int(word))
        broken = judge_field(field, header)
        if broken:
            raise Refused(broken[0], field, byte, broken[1])
    if len(words) > len(FIELDS):
        raise Refused("R4", "header", words[len(FIELDS)][0], "more than eleven fields")
    if header.size > limit:
        byte = words[-2][0]
        raise Refused("R24", "width", byte, f"{header.size} bytes of elements, limit {limit}")
    return header


def judge_field(field, header):
    """The rule of R17 to R23 that the field last read breaks, and why; None when it breaks none."""
    if field == "info":
        return judge_info(header.info)
    side = getattr(header, field)
    if field in ("width", "height") and header.encoding == "jpeg":
        if not 1 <= side <= MAX_JPEG_SIDE:
            return "R21", f"a jpeg's side is 1 to {MAX_JPEG_SIDE}, not {side}"
    if field == "width" and header.type == "sparse_graph" and side != 1:
        return "R22", f"the width of a sparse_graph is 1, not {side}"
    if field == "height" and header.type == "dense_graph" and side != header.width:
        return "R23", f"the height of a dense_graph is its width {header.width}, not {side}"
    return None


def judge_info(info):
    """The rule of R17 to R21 that `info` breaks, and why; None when it breaks none."""
    if info // 10000 not in TYPES:
        return "R17", f"no matrix type {info // 10000}"
    header = Header(info=info)
    name, components, scalars = TYPES[info // 10000]
    if header.components not in components:
        return "R18", f"{name} does not have {header.components} components"
    if header.scalar not in scalars:
        return "R19", f"{name} does not have the scalar {header.scalar}"
    if info % 10 >= len(ENCODINGS):
        return "R20", f"encoding {info % 10} is reserved"
    if header.encoding == "jpeg":
        if (name, header.components) not in (("rgb_image", 3), ("intensity_image", 1)):
            return "R21", f"jpeg is not for {name} of {header.components} components"
        if header.scalar != "u8":
            return "R21", f"jpeg is not for the scalar {header.scalar}"
    return None


def show(word):
    """A word of a stream for a person: in quotes, what is not ASCII escaped, never long."""
    return repr(bytes(word[:40]))[1:]
