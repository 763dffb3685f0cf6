#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A second reader and writer of MTP/1, from spec/mtp-1.md alone and the standard library alone.

It shares nothing with the C++ library, so that where the two agree the specification is clear. It is
a basic reader: it delivers the compressed encodings as the bytes that came.

    mtp1.py json [FILE]            one JSON line a message (section 8)
    mtp1.py canon [FILE]           the same messages in canonical form
    mtp1.py refusal [FILE]         {"rule":…,"field":…,"byte":…,"messages":…}, or {} for a valid stream
    mtp1.py random SEED COUNT [--loose]   random messages, canonical or in other valid spellings
"""

import json
import math
import random
import re
import struct
import sys
from fractions import Fraction

LIMIT = 256 << 20
FIELDS = "version src dst seq ttl time info mode coord width height".split()
MAX31, MAX63 = 2**31 - 1, 2**63 - 1
RANGES = [(1, 1), (0, MAX31), (-(2**31), MAX31), (0, MAX63), (0, 255), (0, MAX63)]
RANGES += [(0, MAX31)] * 5
ALL, FLOATS = set(range(10)), {8, 9}
TYPES = {  # number: name, components, scalars
    1: ("position", {3, 6, 9}, FLOATS),
    2: ("rotation", {3, 6, 9}, FLOATS),
    3: ("rgb_image", {3, 4}, {0, 2, 8, 9}),
    4: ("intensity_image", {1}, ALL),
    5: ("vector_field", set(range(1, 100)), ALL),
    6: ("string", {1}, {0}),
    7: ("transformation", {1}, FLOATS),
    8: ("dense_graph", set(range(1, 100)), ALL),
    9: ("sparse_graph", set(range(2, 100)), ALL),
    10: ("sound", set(range(1, 100)), ALL),
    11: ("map", set(range(1, 100)), ALL),
    12: ("table", set(range(1, 100)), ALL),
}
SCALARS = "u8 i8 u16 i16 u32 i32 u64 i64 f32 f64".split()
PACK = "BbHhIiQqfd"
ENCODINGS = "text binary zstd jpeg".split()
INTEGER = re.compile(rb"(0|-?[1-9][0-9]*)\Z")
FLOAT = re.compile(rb"-?(([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?|(?i:nan|inf|infinity))\Z")


class Refused(Exception):
    """A stream breaks a rule. `messages` whole ones came before."""

    def __init__(self, rule, field, byte, reason=""):
        super().__init__("R%d %s byte %d: %s" % (rule, field, byte, reason))
        self.rule, self.field, self.byte, self.messages = rule, field, byte, 0


class Message:
    """Eleven integers, and the numbers of the matrix in one flat list; bytes for a string and for
    what is compressed."""

    def __init__(self, header, elements):
        self.header = list(header)
        self.elements = elements

    def __getattr__(self, name):
        if name in FIELDS:
            return self.header[FIELDS.index(name)]
        raise AttributeError(name)

    type = property(lambda self: self.info // 10000)
    components = property(lambda self: self.info // 100 % 100)
    scalar = property(lambda self: self.info // 10 % 10)
    encoding = property(lambda self: self.info % 10)


class Bytes:
    """A stream that is read from the front; knows at which byte it stands."""

    def __init__(self, stream):
        self.stream, self.buffer, self.at, self.base, self.ended = stream, b"", 0, 0, False

    def byte(self):
        return self.base + self.at

    def fill(self):
        """Gets more bytes; false at the end of the stream."""
        read = getattr(self.stream, "read1", self.stream.read)
        more = b"" if self.ended else read(65536)
        self.ended = not more
        self.buffer, self.base, self.at = self.buffer[self.at :] + more, self.byte(), 0
        return bool(more)

    def peek(self, size):
        """The next bytes, fewer than `size` only at the stream's end."""
        while len(self.buffer) - self.at < size and self.fill():
            pass
        return self.buffer[self.at : self.at + size]

    def take(self, size):
        """Just `size` bytes."""
        parts, left = [], size
        while left > 0:
            part = self.peek(min(left, 65536))
            if not part:
                raise Refused(2, "stream", self.byte(), "truncated")
            parts.append(part)
            self.at += len(part)
            left -= len(part)
        return b"".join(parts)


def read(stream, limit=LIMIT):
    """Yields the messages of a binary stream; raises Refused."""
    source, messages = Bytes(stream), 0
    while source.peek(1):
        try:
            message = read_message(source, limit)
        except Refused as refused:
            refused.messages = messages
            raise
        messages += 1
        yield message


def read_message(source, limit):
    header = read_header(source, limit)
    info, width, height = header[6], header[9], header[10]
    kind, components, scalar, encoding = (
        info // 10000,
        info // 100 % 100,
        info // 10 % 10,
        info % 10,
    )
    size = width * height * components * struct.calcsize(PACK[scalar])
    if encoding >= 2:
        elements = source.take(read_length(source, limit))
    elif kind == 6:
        elements = source.take(width * height)
    elif encoding == 0 and width * height > 0:
        rows = [read_row(source, width * components, scalar) for _ in range(height)]
        return Message(header, [number for row in rows for number in row])
    else:
        data = source.take(size)
        elements = list(struct.unpack("<%d%s" % (width * height * components, PACK[scalar]), data))
        if scalar in FLOATS:
            elements = keep_bits(data, elements, scalar)
    end = source.peek(2)
    if end[:1] == b"\n":
        source.at += 1
    elif encoding == 0 and end == b"\r\n":
        source.at += 2
    elif not end or (encoding == 0 and end == b"\r"):
        raise Refused(2, "stream", source.byte() + len(end), "truncated")
    else:
        raise Refused(26, "elements", source.byte(), "no line feed closes the elements")
    return Message(header, elements)


class Bits(float):
    """A float that was read in binary, with its bytes: not-a-numbers have a payload."""

    data = None


def keep_bits(data, numbers, scalar):
    size = struct.calcsize(PACK[scalar])
    result = []
    for i, number in enumerate(numbers):
        if number != number:
            number = Bits(number)
            number.data = data[i * size : (i + 1) * size]
        result.append(number)
    return result


def read_header(source, limit):
    begin, line = source.byte(), source.peek(256)
    end = line.find(b"\n")
    if end < 0:
        if len(line) == 256:
            raise Refused(3, "header", begin + 256, "no line feed")
        raise Refused(2, "stream", begin + len(line), "truncated")
    source.at += end + 1
    line = line[:end]
    if line.endswith(b"\r"):
        line = line[:-1]
    tokens = [(m.start(), m.group()) for m in re.finditer(rb"[^ ]+", line)]
    header, begins = [], []
    for i, field in enumerate(FIELDS):
        if i == len(tokens):
            raise Refused(4, field, begin + len(line), "missing")
        at, token = tokens[i]
        begins.append(begin + at)
        if not INTEGER.match(token):
            raise Refused(5, field, begin + at, "no integer")
        value = int(token)
        if not RANGES[i][0] <= value <= RANGES[i][1]:
            raise Refused(6 + i, field, begin + at, "out of range")
        header.append(value)
        check_field(field, header, begin + at)
    if len(tokens) > 11:
        raise Refused(4, "header", begin + tokens[11][0], "more than eleven fields")
    info = header[6]
    element = info // 100 % 100 * struct.calcsize(PACK[info // 10 % 10])
    if header[9] * header[10] * element > limit:
        raise Refused(24, "width", begins[9], "over the limit")
    return header


def check_field(field, header, byte):
    """The rules that a field breaks together with those before it (R17 … R23)."""
    if field not in ("info", "width", "height"):
        return
    info, value = header[6], header[-1]
    kind, components, scalar, encoding = (
        info // 10000,
        info // 100 % 100,
        info // 10 % 10,
        info % 10,
    )
    if field == "info":
        if kind not in TYPES:
            raise Refused(17, field, byte, "no matrix type")
        if components not in TYPES[kind][1]:
            raise Refused(18, field, byte, "components")
        if scalar not in TYPES[kind][2]:
            raise Refused(19, field, byte, "scalar")
        if encoding >= len(ENCODINGS):
            raise Refused(20, field, byte, "encoding %d is reserved" % encoding)
        if encoding == 3 and not (scalar == 0 and (kind, components) in ((3, 3), (4, 1))):
            raise Refused(21, field, byte, "no jpeg of this")
        return
    if encoding == 3 and not 1 <= value <= 65500:
        raise Refused(21, field, byte, "side of a jpeg picture")
    if field == "width" and kind == 9 and value != 1:
        raise Refused(22, field, byte, "width of a sparse graph")
    if field == "height" and kind == 8 and value != header[9]:
        raise Refused(23, field, byte, "a dense graph is square")


def read_length(source, limit):
    begin, line = source.byte(), source.peek(21)
    end = line.find(b"\n")
    if end < 0 and len(line) < 21:
        raise Refused(2, "stream", begin + len(line), "truncated")
    token = line[:end] if end >= 0 else line
    if end < 0 or not INTEGER.match(token) or token.startswith(b"-"):
        raise Refused(34, "length", begin, "no number of bytes")
    if int(token) > limit:
        raise Refused(35, "length", begin, "over the limit")
    source.at += end + 1
    return int(token)


def read_row(source, count, scalar):
    """One line of `count` numbers."""
    row = []
    while True:
        while source.peek(1) == b" ":
            source.at += 1
        ahead = source.peek(66)
        if not ahead or ahead == b"\r":
            raise Refused(2, "stream", source.byte() + len(ahead), "truncated")
        if ahead[:1] == b"\n" or ahead[:2] == b"\r\n":
            if len(row) < count:
                raise Refused(29, "elements", source.byte(), "too few numbers")
            source.at += 1 if ahead[:1] == b"\n" else 2
            return row
        end = re.search(rb"\r?\n| |\r?\Z", ahead)
        size = end.start()
        if size > 64:
            raise Refused(31, "elements", source.byte(), "more than 64 bytes")
        if end.group() in (b"", b"\r") and end.end() == len(ahead) and len(ahead) < 66:
            raise Refused(2, "stream", source.byte() + len(ahead), "truncated")
        if len(row) == count:
            raise Refused(30, "elements", source.byte(), "too many numbers")
        row.append(read_number(ahead[:size], scalar, source.byte()))
        source.at += size


def read_number(token, scalar, byte):
    if scalar not in FLOATS:
        if not INTEGER.match(token):
            raise Refused(27, "elements", byte, "no integer")
        try:
            struct.pack("<" + PACK[scalar], int(token))
        except struct.error:
            raise Refused(28, "elements", byte, "does not fit") from None
        return int(token)
    if not FLOAT.match(token):
        raise Refused(27, "elements", byte, "no number")
    text = token.decode().lower().rstrip("ity") if b"i" in token.lower() else token.decode()
    if not any(c.isdigit() for c in text):
        return float(text.replace("infin", "inf"))
    value = float(text) if scalar == 9 else to_f32(text)
    if math.isinf(value):
        raise Refused(28, "elements", byte, "too large")
    return value


def to_f32(text):
    """The f32 nearest to a decimal number, ties to even, rounded once."""
    exponent = int(re.split("[eE]", text)[1]) if re.search("[eE]", text) else 0
    if abs(exponent) > 1000:
        double = float(text)
        return math.copysign(math.inf if abs(double) > 1 else 0.0, double)
    exact = Fraction(text if not text.endswith(".") else text + "0")
    sign = -1.0 if text.startswith("-") else 1.0
    exact = abs(exact)
    if exact == 0:
        return sign * 0.0
    # The spacing of f32 around the number, no finer than that of the smallest ones.
    power = exact.numerator.bit_length() - exact.denominator.bit_length()
    while Fraction(2) ** power > exact:
        power -= 1
    while Fraction(2) ** (power + 1) <= exact:
        power += 1
    step = Fraction(2) ** max(power - 23, -149)
    rounded = round(exact / step) * step  # round() of a Fraction takes ties to even
    if rounded >= Fraction(2) ** 128:
        return sign * math.inf
    return sign * float(rounded)


def spell(number, scalar):
    """A number in canonical form (R39)."""
    if scalar not in FLOATS:
        return str(number)
    if number != number:
        return "nan"
    if math.isinf(number):
        return "inf" if number > 0 else "-inf"
    sign = "-" if math.copysign(1, number) < 0 else ""
    number = abs(float(number))
    if number == 0:
        return sign + "0"
    digits, exponent = shortest(number, scalar)
    mantissa = digits[0] + ("." + digits[1:] if len(digits) > 1 else "")
    scientific = "%se%s%02d" % (mantissa, "+" if exponent >= 0 else "-", abs(exponent))
    if exponent >= len(digits) - 1:
        fixed = str(int(number))
    elif exponent >= 0:
        fixed = digits[: exponent + 1] + "." + digits[exponent + 1 :]
    else:
        fixed = "0." + "0" * (-exponent - 1) + digits
    return sign + (fixed if len(fixed) <= len(scientific) else scientific)


def shortest(number, scalar):
    """The fewest digits that read back to the same bits, and the power of ten of the first."""
    for count in range(17):
        for text in candidates(number, count) if scalar == 8 else [repr(number)]:
            if scalar == 9 or to_f32(text) == number:
                mantissa, _, power = ("%.17e" % number if "e" not in text else text).partition("e")
                if "e" not in text:  # repr in fixed notation
                    digits = text.replace(".", "")
                    point = text.index(".") if "." in text else len(text)
                    lead = len(digits) - len(digits.lstrip("0"))
                    digits = digits.lstrip("0").rstrip("0")
                    return digits, point - lead - 1
                return mantissa.replace(".", "").rstrip("0") or "0", int(power)
    raise AssertionError(number)


def candidates(number, count):
    """Decimals with 1 + `count` digits next to a number, the nearest first."""
    near = "%.*e" % (count, number)
    mantissa, _, power = near.partition("e")
    digits = int(mantissa.replace(".", ""))
    texts = ["%de%d" % (digits + d, int(power) - count) for d in (0, 1, -1) if digits + d > 0]
    texts.sort(key=lambda text: abs(Fraction(text) - Fraction(number)))
    return ["%.*e" % (count, float(text)) for text in texts]


def write(message):
    """A message's bytes, canonical but for what is compressed."""
    line = " ".join(str(value) for value in message.header).encode() + b"\n"
    elements = message.elements
    if message.encoding >= 2:
        return line + b"%d\n" % len(elements) + elements + b"\n"
    if message.type == 6:
        return line + elements + b"\n"
    if message.encoding == 1:
        code = "<" + PACK[message.scalar]
        return (
            line
            + b"".join(getattr(n, "data", None) or struct.pack(code, n) for n in elements)
            + b"\n"
        )
    count = message.width * message.components
    if not elements:
        return line + b"\n"
    words = [spell(number, message.scalar) for number in elements]
    rows = [" ".join(words[i : i + count]) for i in range(0, len(words), count)]
    return line + "\n".join(rows).encode() + b"\n"


def to_json(message):
    """The JSON form of section 8."""
    parts = ['"%s":%d' % pair for pair in zip(FIELDS, message.header)]
    parts.append('"type":"%s","components":%d' % (TYPES[message.type][0], message.components))
    parts.append('"scalar":"%s"' % SCALARS[message.scalar])
    parts.append('"encoding":"%s"' % ENCODINGS[message.encoding])
    return "{" + ",".join(parts) + ',"elements":' + elements_json(message) + "}"


def elements_json(message):
    width, components = message.width, message.components
    if message.encoding >= 2:
        return "null"
    if message.width * message.height == 0:
        return "[]"
    if message.type == 6:
        rows = [message.elements[i : i + width] for i in range(0, len(message.elements), width)]
        return "[" + ",".join(string_json(row) for row in rows) + "]"
    words = [spell(number, message.scalar) for number in message.elements]
    words = ['"%s"' % word if word[-1] in "nf" else word for word in words]
    if components > 1:
        groups = [words[i : i + components] for i in range(0, len(words), components)]
        words = ["[" + ",".join(group) + "]" for group in groups]
    rows = [words[i : i + width] for i in range(0, len(words), width)]
    return "[" + ",".join("[" + ",".join(row) + "]" for row in rows) + "]"


UTF8 = re.compile(
    rb"[\x00-\x7f]|[\xc2-\xdf][\x80-\xbf]|\xe0[\xa0-\xbf][\x80-\xbf]|\xed[\x80-\x9f][\x80-\xbf]"
    rb"|[\xe1-\xec\xee\xef][\x80-\xbf]{2}|\xf0[\x90-\xbf][\x80-\xbf]{2}"
    rb"|[\xf1-\xf3][\x80-\xbf]{3}|\xf4[\x80-\x8f][\x80-\xbf]{2}|[\x80-\xff]"
)
ESCAPES = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\r": "\\r", "\t": "\\t"}


def string_json(data):
    text = ""
    for character in UTF8.findall(data):
        c = character.decode("utf-8", "replace")
        text += ESCAPES.get(c) or ("\\u%04x" % ord(c) if ord(c) < 0x20 else c)
    return '"' + text + '"'


def random_message(rng):
    """Any message of text or binary elements, small more often than not."""
    kind = rng.choice(list(TYPES))
    components = rng.choice(sorted(TYPES[kind][1])[: rng.choice((1, 4, 99))])
    scalar, encoding = rng.choice(sorted(TYPES[kind][2])), rng.choice((0, 1))
    width, height = rng.choice((0, 1, 1, 2, 3, 7)), rng.choice((0, 1, 1, 2, 5))
    width = 1 if kind == 9 else width
    height = width if kind == 8 else height
    header = [1]
    for low, high in RANGES[1:6]:
        header.append(
            rng.choice((low, high, 0, rng.randint(low, high), rng.randint(0, min(high, 99))))
        )
    header.append(kind * 10000 + components * 100 + scalar * 10 + encoding)
    header += [rng.choice((0, 3, 100, MAX31)), rng.choice((0, 9, 1003, MAX31)), width, height]
    count = width * height * components
    if kind == 6:
        return Message(
            header, bytes(rng.choice((rng.randrange(256), 10, 65, 32)) for _ in range(count))
        )
    return Message(header, [random_number(rng, scalar, encoding) for _ in range(count)])


def random_number(rng, scalar, encoding):
    size = struct.calcsize(PACK[scalar])
    if scalar not in FLOATS:
        low = 0 if scalar % 2 == 0 else -(1 << (8 * size - 1))
        high = low + (1 << (8 * size)) - 1
        return rng.choice((low, high, rng.randint(low, high), rng.randint(0, 100)))
    data = rng.choice(
        (
            rng.getrandbits(8 * size).to_bytes(size, "little"),
            struct.pack(
                "<" + PACK[scalar], rng.choice((0.0, -0.0, math.inf, -math.inf, 1e5, 100.0))
            ),
            struct.pack("<" + PACK[scalar], rng.randint(-9999, 9999) / 10 ** rng.randint(0, 6)),
            struct.pack("<" + PACK[scalar], float(2 ** rng.randint(0, 100))),
            rng.getrandbits(12).to_bytes(size, "little"),
        )
    )
    number = struct.unpack("<" + PACK[scalar], data)[0]
    if number == number:
        return number
    return keep_bits(data, [number], scalar)[0] if encoding == 1 else math.nan


def loosen(data, message, rng):
    """Another valid spelling of a canonical message."""
    head, _, body = data.partition(b"\n")
    gap = lambda: b" " * rng.choice((1, 1, 2, 3))
    edge = lambda: b" " * rng.choice((0, 0, 1, 2))
    end = rng.choice((b"\n", b"\r\n"))
    line = edge() + gap().join(head.split(b" ")) + edge()
    line += end if len(line) < 250 else b"\n"
    if len(line) > 256:
        line = head + b"\n"
    if message.encoding != 0:
        return line + body
    if message.type == 6 or not message.elements:
        return line + body[:-1] + end
    rows = []
    for row in body[:-1].split(b"\n"):
        words = [loose_number(word, message.scalar, rng) for word in row.split(b" ")]
        rows.append(edge() + gap().join(words) + edge() + end)
    return line + b"".join(rows)


def loose_number(word, scalar, rng):
    if scalar not in FLOATS or rng.random() < 0.5:
        return word
    if word[-1:] in b"nf":
        word = word.replace(b"inf", rng.choice((b"inf", b"Inf", b"INFINITY")))
        return word.replace(b"nan", rng.choice((b"nan", b"NaN")))
    if b"e" in word:
        return word.replace(b"e", b"E").replace(b"E+", rng.choice((b"E+", b"E")))
    if b"." in word:
        return word + b"0" * rng.randint(0, 3)
    return word + rng.choice((b".", b".0", b"e0", b"E+00"))


def main(arguments):
    verb, rest = arguments[0], arguments[1:]
    out = sys.stdout.buffer
    if verb == "random":
        rng = random.Random(int(rest[0]))
        for _ in range(int(rest[1])):
            message = random_message(rng)
            data = write(message)
            out.write(loosen(data, message, rng) if "--loose" in rest else data)
        return 0
    stream = open(rest[0], "rb") if rest and rest[0] != "-" else sys.stdin.buffer
    refusal = {}
    try:
        for message in read(stream):
            if verb == "json":
                out.write(to_json(message).encode() + b"\n")
            elif verb == "canon":
                out.write(write(message))
    except Refused as refused:
        refusal = {"rule": "R%d" % refused.rule, "field": refused.field}
        refusal.update(byte=refused.byte, messages=refused.messages)
        if verb != "refusal":
            out.flush()
            print("%s (after %d messages)" % (refused, refused.messages), file=sys.stderr)
            return 1
    if verb == "refusal":
        print(json.dumps(refusal, separators=(",", ":")))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
