# SPDX-License-Identifier: Apache-2.0
"""What the cases are made with: `good` and `bad` take down a vector, `message` spells one message.

Bytes and results are both stated by hand; nothing here reads a message. The one thing counted is
the byte of a refusal: a refused stream is given in two pieces, and the second begins where it is
refused.
"""

import json

TYPES = "position rotation rgb_image intensity_image vector_field string transformation dense_graph"
TYPES = (TYPES + " sparse_graph sound map table").split()
SCALARS = "u8 i8 u16 i16 u32 i32 u64 i64 f32 f64".split()
ENCODINGS = "text binary zstd jpeg".split()
FIELDS = "version src dst seq ttl time info mode coord width height".split()

valid = {}
invalid = {}


def twin(header, elements):
    """The JSON line of a message: the header's eleven integers as written, elements as given."""
    numbers = [int(word) for word in header.split()]
    info = numbers[6]
    parts = ['"%s":%d' % pair for pair in zip(FIELDS, numbers)]
    parts.append('"type":"%s"' % TYPES[info // 10000 - 1])
    parts.append('"components":%d' % (info // 100 % 100))
    parts.append('"scalar":"%s"' % SCALARS[info // 10 % 10])
    parts.append('"encoding":"%s"' % ENCODINGS[info % 10])
    return "{" + ",".join(parts) + ',"elements":' + elements + "}"


def message(header, body, elements, end="\n"):
    """One message: header line without its end, bytes between it and the closing line feed."""
    if isinstance(body, str):
        body = body.encode()
    return header.encode() + end.encode() + body + end.encode(), twin(header, elements)


def good(name, *messages):
    assert name not in valid, name
    valid[name] = (b"".join(m[0] for m in messages), "".join(m[1] + "\n" for m in messages))


def bad(name, rule, field, before, rest, messages=0):
    """A stream that is refused where `rest` begins."""
    assert name not in invalid, name
    before, rest = (x.encode() if isinstance(x, str) else x for x in (before, rest))
    result = {"rule": rule, "field": field, "byte": len(before), "messages": messages}
    invalid[name] = (before + rest, json.dumps(result, separators=(",", ":")) + "\n")


H = "1 12 0 1042 8 1763683200123456789 %d 1 %d %d %d"  # info, coord, width, height

T = "1 7 0 0 8 0 "  # a header's version … time
P = T + "10390 1 3 1 1\n"  # the header of a position, 26 bytes
ONE = P + "0.1 0.2 0.3\n"  # a whole message, 38 bytes


def part(data):
    """A compressed part: its length line and its bytes."""
    return b"%d\n" % len(data) + data
