# SPDX-License-Identifier: Apache-2.0
"""Random messages, other valid spellings of them, and damaged ones; the same for the same seed."""

import math

from mtp1_header import FIELDS, I31, TYPES, Header, Message
from mtp1_number import FLOATS, SCALARS, nearest

MAX_BLOCK = 128 << 10  # bytes; RFC 8878, 3.1.1.2.4


def random_message(rng):
    """A message in text, binary or zstd that writes and reads back; small, now and then less so."""
    header = random_header(rng)
    tt = rng.choice(list(TYPES))
    name, components, scalars = TYPES[tt]
    cc = rng.choice(components if rng.random() < 0.1 else components[:3])
    s = SCALARS.index(rng.choice(scalars))
    header.info = tt * 10000 + cc * 100 + s * 10 + rng.choice((0, 0, 1, 1, 2))
    header.width, header.height = random_sides(rng, name)
    if name == "string":
        elements = random_string(rng, header.size)
    else:
        count = header.size // header.code.size
        elements = b"".join(random_number(rng, header) for _ in range(count))
    return Message(
        header, elements, random_zstd(rng, elements) if header.encoding == "zstd" else b""
    )


def random_header(rng):
    """Any header, by the ranges of its fields alone."""
    return Header(*(random_field(rng, least, most) for _, least, most in FIELDS))


def random_sides(rng, name):
    """A width and a height that go with a matrix type; the empty matrix in all its shapes."""
    most = rng.choice((1, 4, 4, 4, 4, 4, 4, 20))
    width, height = rng.randrange(most + 1), rng.randrange(most + 1)
    if name == "sparse_graph":
        return 1, height
    if name == "dense_graph":
        return width, width
    if not width * height:
        return rng.choice(((0, 0), (0, 7), (7, 0), (0, I31), (I31, 0)))
    return width, height


def random_field(rng, least, most):
    """A header field: often at an end of its range, else of any size."""
    ends = (least, most, min(most, max(least, 0)), min(most, 1))
    return rng.choice(ends) if rng.random() < 0.4 else random_integer(rng, least, most)


def random_integer(rng, least, most):
    """An integer of a range, small ones as likely as large ones."""
    value = rng.getrandbits(rng.randrange(1, 65)) * rng.choice((1, -1))
    return min(most, max(least, value))


def random_string(rng, size):
    """Bytes: text of any script, or anything at all."""
    if rng.random() < 0.5:
        return bytes(rng.choice((rng.randrange(256), 10, 13, 34, 92, 65)) for _ in range(size))
    letters = "".join(
        rng.choice("hello \u00e9\u0436\u4e2d\U0001f916\ufffd\u2028\t") for _ in range(size)
    )
    return letters.encode()[:size]


def random_bytes(rng, size):
    """Bytes with something to compress, of one of six kinds."""
    kind, step = rng.randrange(6), rng.randrange(1, 9)
    if kind == 0:
        return rng.randbytes(size)
    if kind == 1:
        return bytes(at * at // (40 * step) % 256 for at in range(size))
    if kind == 2:  # frequent and rare ones
        return bytes(int(rng.expovariate(step / 50)) % 256 for _ in range(size))
    if kind == 3:
        return bytes(rng.choice((0, step, 3, 9)) for _ in range(size))
    words = [rng.randbytes(rng.randrange(1, 12)) for _ in range(step)]
    some = b""
    while len(some) < size:
        some += rng.choice(words) * (rng.randrange(1, 40) if kind == 4 else 1)
        some += rng.randbytes(rng.choice((0, 0, 1, 3)))
    return some[:size]


def random_number(rng, header):
    """The bytes of a scalar; in text nan has no sign and no payload."""
    code = header.code
    if header.scalar not in FLOATS:
        bits = 8 * code.size
        least = -(2 ** (bits - 1)) if header.scalar[0] == "i" else 0
        most = 2 ** (bits if least == 0 else bits - 1) - 1
        return code.pack(random_field(rng, least, most))
    number = random_float(rng, code)
    is_nan = math.isnan(code.unpack(number)[0])
    return code.pack(math.nan) if is_nan and header.encoding == "text" else number


def random_float(rng, code):
    """The bytes of a float: any bits, or a special one, or one as people write them."""
    kind = rng.randrange(6)
    if kind == 0:
        return rng.getrandbits(8 * code.size).to_bytes(code.size, "little")
    if kind == 1:
        return rng.choice(special_floats(code.size))
    if kind == 2:  # subnormal, of either sign
        bits = rng.getrandbits(rng.randrange(1, 24 if code.size == 4 else 53))
        return (bits | rng.getrandbits(1) << (8 * code.size - 1)).to_bytes(code.size, "little")
    if kind == 3:
        return code.pack(rng.randrange(-(10**5), 10**5) * 10.0 ** rng.randrange(-8, 8))
    if kind == 4:
        return code.pack(rng.choice((-1, 1)) * 2.0 ** rng.randrange(-126, 128))
    return code.pack(rng.uniform(-2, 2))


def special_floats(size):
    """Bytes of the floats at the edges: zeros, infinities, ends of ranges, nan with payloads."""
    mantissa, exponent = (23, 8) if size == 4 else (52, 11)
    one, inf = 1 << mantissa, ((1 << exponent) - 1) << mantissa  # one: the least normal number
    tops = (0, inf, 1, one - 1, one, inf - 1, inf | one >> 1, inf | 1, inf | one - 1)
    sign = 1 << (8 * size - 1)
    return [bits.to_bytes(size, "little") for top in tops for bits in (top, top | sign)]


# ------------------------------------------------------------------------------------------- zstd


def random_zstd(rng, data):
    """The data in one to three zstd frames of blocks as they are (RFC 8878, 3.1), or skippable ones
    between them."""
    cuts = sorted(rng.randrange(len(data) + 1) for _ in range(rng.choice((0, 0, 1, 2))))
    frames = b""
    for start, end in zip([0] + cuts, cuts + [len(data)]):
        frames += b"\x28\xb5\x2f\xfd\x00\x58"  # the size not given, a window of 2 MiB
        for at in range(start, end, MAX_BLOCK):
            block = data[at : min(at + MAX_BLOCK, end)]
            frames += (len(block) << 3).to_bytes(3, "little") + block
        frames += b"\x01\0\0"  # the last block, which is empty
        if rng.random() < 0.1:
            some = rng.randbytes(rng.randrange(9))
            frames += b"\x50\x2a\x4d\x18" + len(some).to_bytes(4, "little") + some
    return frames


# -------------------------------------------------------------------------------- other spellings


def loosen(message, data, rng):
    """Other bytes that are read as the same message as its canonical bytes (R5, R26, R27)."""
    header = message.header
    line, _, elements = data.partition(b"\n")
    loose = loose_line(line.split(), rng)
    if header.encoding != "text":
        return loose + elements
    if header.type == "string" or not header.size:
        return loose + message.elements + rng.choice((b"\n", b"\r\n"))
    for row in elements.splitlines():
        words = row.split()
        if header.scalar in FLOATS:
            words = [loose_float(word.decode(), header.scalar, rng).encode() for word in words]
        loose += loose_line(words, rng)
    return loose


def loose_line(words, rng):
    """The words with any spaces between and around, ended by LF or CR LF."""
    gaps = [b" " * rng.choice((1, 1, 1, 2, 5)) for _ in words]
    line = b"".join(word + gap for word, gap in zip(words, gaps))
    line = line if rng.random() < 0.3 else line.rstrip(b" ")
    return b" " * rng.choice((0, 0, 0, 1, 3)) + line + rng.choice((b"\n", b"\r\n"))


def loose_float(text, scalar, rng):
    """Another spelling of the same float."""
    sign, magnitude = ("-", text[1:]) if text.startswith("-") else ("", text)
    if magnitude == "nan":
        return rng.choice(("nan", "-nan", "NaN", "-NAN"))
    if magnitude == "inf":
        return sign + rng.choice(("inf", "INF", "Infinity", "iNfInItY"))
    value = nearest(magnitude, scalar)
    spellings = (
        magnitude + (".0" if magnitude.isdigit() else ""),
        magnitude + ("." if magnitude.isdigit() else ""),
        magnitude.replace("e", "E"),
        magnitude.replace("e+", "e"),
        "00" + magnitude,
        magnitude[1:] if magnitude.startswith("0.") else magnitude,
        f"{value:.17e}",
        f"{value:.{rng.randrange(20, 50)}E}",
    )
    return sign + rng.choice(spellings)


# ----------------------------------------------------------------------------------------- damage


def damage(rng, data, start=0):
    """Other bytes: one changed, some lost, some twice, or the end cut off; none before `start`."""
    at = rng.randrange(start, len(data))
    count = rng.choice((1, 1, 2, 9, 100))
    kind = rng.randrange(8)
    if kind == 0:
        return data[:at]
    if kind == 1:
        return data[:at] + data[at + count :]
    if kind == 2:
        return data[: at + count] + data[at:]
    flipped = data[at] ^ 1 << rng.randrange(8)
    byte = rng.choice((flipped, rng.randrange(256), rng.choice(b" \n\r-.059ei")))
    return data[:at] + bytes([byte]) + data[at + 1 :]
