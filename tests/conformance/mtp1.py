#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reads and writes MTP/1 (spec/mtp-1.md), written from the specification and nothing else.

    import mtp1
    for message in mtp1.read(sys.stdin.buffer):
        print(mtp1.to_json(message))

It shares no line with the C++ library, so that where the two agree the specification is clear. It
is plain, not fast: standard library only, one function a rule or two, the rule's number beside it.
Compressed elements are expanded by the programs zstd and djpeg (R36, R37).
On the command line (FILE is standard input when it is missing or `-`):

    mtp1.py json [--basic] [FILE]        one JSON line a message (section 8)
    mtp1.py canon [--basic] [FILE]       the same messages in canonical form (section 5)
    mtp1.py refusal [--basic] [FILE]     {"rule":...,"field":...,"byte":...,"messages":...} or {}
    mtp1.py random SEED COUNT [--loose]  random messages, canonical or in other valid spellings

`--basic` leaves compressed elements as they came. Exit status: 0 done, 1 refused, 2 usage;
`refusal` gives its answer on standard output and ends with 0.
"""

import argparse
import codecs
import json
import math
import os
import random
import re
import struct
import sys
from dataclasses import astuple

from mtp1_expand import expand_jpeg, expand_zstd
from mtp1_header import FIELDS, Message, Refused, judge_header, show
from mtp1_number import FLOAT, FLOATS, INTEGER, nearest, spell
from mtp1_random import loosen, random_message

LIMIT = 256 << 20  # bytes; R24
MAX_HEADER = 256  # bytes with the line feed; R3
MAX_NUMBER = 64  # bytes; R31
MAX_LENGTH = 20  # bytes without the line feed; R34
CHUNK = 1 << 16  # bytes asked of a stream at a time

NUMBER = re.compile(rb" *([^ \n]*)([ \n])")  # with what is before it and the byte that ends it


# ---------------------------------------------------------------------------------------- reading


class Source:
    """The bytes of a stream that came and were not used yet, and where in the stream they stand."""

    def __init__(self, stream):
        self.stream = stream
        self.read_some = getattr(stream, "read1", None) or getattr(stream, "read", None)
        self.held = bytearray()  # bytes that came, from `byte - used` on
        self.used = 0  # how many of them are used up
        self.byte = 0  # place in the stream of the next byte
        if isinstance(stream, (bytes, bytearray, memoryview)):
            self.held += stream
            self.read_some = lambda count: b""

    @property
    def ready(self):
        """How many bytes are at hand."""
        return len(self.held) - self.used

    def more(self):
        """Waits for some bytes; False at the end of the stream. Memory grows by what came alone."""
        if self.used:
            del self.held[: self.used]
            self.used = 0
        some = self.read_some(CHUNK)
        self.held += some or b""
        return bool(some)

    def need(self, count):
        """Waits until `count` bytes are at hand. R2 where the stream ends before."""
        while self.ready < count:
            if not self.more():
                raise Refused("R2", "stream", self.byte + self.ready, "truncated inside a message")

    def skip(self, count):
        """Uses up `count` bytes that are at hand."""
        self.used += count
        self.byte += count

    def take(self, count):
        """The next `count` bytes, waiting for them."""
        self.need(count)
        some = bytes(self.held[self.used : self.used + count])
        self.skip(count)
        return some

    def line(self, most):
        """The bytes before the next line feed, used up with it; None: `most` bytes hold none."""
        while True:
            end = self.held.find(b"\n", self.used, self.used + most)
            if end >= 0:
                return self.take(end + 1 - self.used)[:-1]
            if self.ready >= most:
                return None
            self.need(self.ready + 1)


def read(stream, limit=LIMIT, expand=True):
    """Yields the messages of a stream, each as soon as its last byte is there.

    stream  bytes, or a binary file, pipe or socket file (read1 or read)
    limit   greatest size [bytes] of elements and of compressed bytes (R24, R35)
    expand  whether compressed elements are expanded; a basic reader leaves them as they came

    Raises Refused at the first rule that is broken, after the messages before it. Nothing is set
    aside for what a header promises: memory grows with the bytes that came.
    """
    source = Source(stream)
    messages = 0
    while source.ready or source.more():  # R1: an empty stream is a valid one
        try:
            message = read_message(source, limit, expand)
        except Refused as refused:
            refused.messages = messages
            raise
        yield message
        messages += 1


def read_message(source, limit, expand):
    """Reads the message that begins at the source's next byte."""
    header = read_header(source, limit)
    if header.encoding in ("zstd", "jpeg"):
        return read_compressed(source, header, limit, expand)
    if header.encoding == "text" and header.type != "string" and header.size:
        rows = (read_row(source, header) for _ in range(header.height))
        return Message(header, b"".join(rows))
    elements = source.take(header.size)  # R32, R33
    read_end(source, header.encoding == "text")
    return Message(header, elements)


def read_header(source, limit):
    """Reads a header line. R3."""
    start = source.byte
    line = source.line(MAX_HEADER)
    if line is None:
        raise Refused("R3", "header", start + MAX_HEADER, "no line feed in 256 bytes")
    return judge_header(line, start, limit)


def read_end(source, may_be_crlf):
    """Reads the line feed that closes the elements. R26."""
    source.need(1)
    if may_be_crlf and source.held[source.used] == 0x0D:
        source.need(2)
        if source.held[source.used + 1] == 0x0A:
            source.skip(1)
    byte = source.held[source.used]
    if byte != 0x0A:
        raise Refused(
            "R26", "elements", source.byte, f"byte {byte:#04x} where a line feed ends them"
        )
    source.skip(1)


def read_row(source, header):
    """Reads one line of numbers and returns their binary form. R27 to R31."""
    row = bytearray()
    count = 0
    while True:
        found = NUMBER.match(source.held, source.used)
        if not found:
            wait_for_number(source)
            continue
        word = found[1]
        ends = found[2] == b"\n"
        if ends and word.endswith(b"\r"):
            word = word[:-1]
        byte = source.byte + found.start(1) - source.used
        if word:
            judge_length(word, byte)
            if count == header.row:
                raise Refused("R30", "elements", byte, f"more than {header.row} numbers in a row")
            row += read_number(word, header, byte)
            count += 1
        if ends and count < header.row:
            place = byte + len(word)
            raise Refused("R29", "elements", place, f"{count} numbers in a row of {header.row}")
        source.skip(found.end() - source.used)
        if ends:
            return bytes(row)


def wait_for_number(source):
    """Waits for more of a number whose end is not there yet. R31 when it is already too long."""
    begun = source.held[source.used :]
    judge_length(begun[:-1] if begun.endswith(b"\r") else begun, source.byte)
    source.need(source.ready + 1)


def judge_length(word, byte):
    """Refuses a number that takes too many bytes. R31."""
    if len(word) > MAX_NUMBER:
        raise Refused("R31", "elements", byte, f"a number longer than {MAX_NUMBER} bytes")


def read_number(word, header, byte):
    """The binary form of the number spelled in `word`. R27, R28."""
    is_float = header.scalar in FLOATS
    if not (FLOAT if is_float else INTEGER).fullmatch(word):
        kind = "a number" if is_float else "an integer"
        raise Refused("R27", "elements", byte, f"{show(word)} is not {kind}")
    try:
        return header.code.pack(nearest(word.decode(), header.scalar) if is_float else int(word))
    except (struct.error, OverflowError):
        reason = f"{show(word)} is out of range of {header.scalar}"
        raise Refused("R28", "elements", byte, reason) from None


def read_compressed(source, header, limit, expand):
    """Reads the elements of encodings zstd and jpeg. R34 to R37."""
    start = source.byte
    line = source.line(MAX_LENGTH + 1)
    if line is None or not INTEGER.fullmatch(line) or line.startswith(b"-"):
        reason = "no number" if line is None else f"{show(line)} is no number of bytes"
        raise Refused("R34", "length", start, reason)
    if int(line) > limit:
        raise Refused("R35", "length", start, f"{int(line)} compressed bytes, limit {limit}")
    start = source.byte
    message = Message(header, None, source.take(int(line)))
    read_end(source, may_be_crlf=False)
    if expand:
        rule = "R36" if header.encoding == "zstd" else "R37"
        try:
            message.elements = expanded(message)
        except ValueError as error:
            raise Refused(rule, "elements", start, str(error)) from None
    return message


def expanded(message):
    """The binary form of compressed elements; ValueError where they hold anything else."""
    header = message.header
    if header.encoding == "zstd":
        return expand_zstd(message.compressed, header.size)
    return expand_jpeg(message.compressed, header.width, header.height, header.components)


# ---------------------------------------------------------------------------------------- writing


def write(message):
    """The canonical bytes of a message (section 5); compressed bytes go out as they are.

    Raises Refused where the header breaks a rule, ValueError where the elements do not fit it.
    """
    header = message.header
    line = b" ".join(b"%d" % field for field in astuple(header))
    judge_header(line, 0, math.inf)
    if header.encoding in ("zstd", "jpeg"):
        if not message.compressed:
            raise ValueError(f"there are no {header.encoding} bytes to write")
        return b"%s\n%d\n%s\n" % (line, len(message.compressed), message.compressed)
    if message.elements is None or len(message.elements) != header.size:
        raise ValueError(f"the header promises {header.size} bytes of elements")
    if header.encoding == "binary" or header.type == "string" or not header.size:
        return line + b"\n" + message.elements + b"\n"
    words = [spell(number, header.scalar) for number in message.numbers()]
    rows = (" ".join(row) + "\n" for row in split(words, header.row))
    return line + b"\n" + "".join(rows).encode()


def split(items, count):
    """The items in lists of `count`."""
    return [items[at : at + count] for at in range(0, len(items), count)]


# ------------------------------------------------------------------------------------------- JSON

ESCAPES = {code: f"\\u{code:04x}" for code in range(0x20)}
ESCAPES.update({ord('"'): '\\"', ord("\\"): "\\\\", 10: "\\n", 13: "\\r", 9: "\\t"})


def one_for_each_byte(error):
    """A codec's way with bytes that are not UTF-8: each of them becomes U+FFFD."""
    return "\ufffd" * (error.end - error.start), error.end


codecs.register_error("mtp1", one_for_each_byte)


def to_json(message):
    """One line of JSON, without its line feed (section 8)."""
    header = message.header
    fields = [f'"{name}":{getattr(header, name)}' for name, _, _ in FIELDS]
    fields.append(f'"type":"{header.type}"')
    fields.append(f'"components":{header.components}')
    fields.append(f'"scalar":"{header.scalar}"')
    fields.append(f'"encoding":"{header.encoding}"')
    fields.append(f'"elements":{elements_json(message)}')
    return "{" + ",".join(fields) + "}"


def elements_json(message):
    """The elements as a list of rows; null where they were not expanded."""
    header = message.header
    if message.elements is None:
        return "null"
    if not header.size:
        return "[]"
    if header.type == "string":
        rows = split(message.elements, header.width)
        return listed(f'"{row.decode("utf-8", "mtp1").translate(ESCAPES)}"' for row in rows)
    words = [spell(number, header.scalar) for number in message.numbers()]
    words = [f'"{word}"' if word in ("nan", "inf", "-inf") else word for word in words]
    if header.components > 1:
        words = [listed(element) for element in split(words, header.components)]
    return listed(listed(row) for row in split(words, header.width))


def listed(words):
    """A JSON list of what is already JSON."""
    return "[" + ",".join(words) + "]"


# ----------------------------------------------------------------------------------- command line


def random_stream(seed, count, loose=False):
    """Yields the bytes of random messages; with `loose` of the same ones spelled otherwise."""
    rng, spelling = random.Random(seed), random.Random(-seed - 1)
    for _ in range(count):
        message = random_message(rng)
        data = write(message)
        yield loosen(message, data, spelling) if loose else data


def refusal(stream, expand):
    """How a stream is refused, as JSON; {} for a valid one."""
    try:
        for _ in read(stream, expand=expand):
            pass
    except Refused as refused:
        return json.dumps(refused.reported(), separators=(",", ":"))
    return "{}"


def show_messages(verb, stream, expand, output):
    """Writes each message as JSON or in canonical form, as soon as it is there."""
    for message in read(stream, expand=expand):
        output.write(write(message) if verb == "canon" else to_json(message).encode() + b"\n")
        output.flush()


def parse(arguments):
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    verbs = parser.add_subparsers(dest="verb", required=True)
    for name in ("json", "canon", "refusal"):
        verb = verbs.add_parser(name)
        verb.add_argument("--basic", action="store_true", help="leave compressed elements alone")
        verb.add_argument("file", nargs="?", default="-")
    verb = verbs.add_parser("random")
    verb.add_argument("seed", type=int)
    verb.add_argument("count", type=int)
    verb.add_argument("--loose", action="store_true", help="valid spellings, not canonical ones")
    return parser.parse_args(arguments)


def main(arguments):
    """Runs a command line; returns the exit status."""
    given = parse(arguments)
    output = sys.stdout.buffer
    try:
        if given.verb == "random":
            output.writelines(random_stream(given.seed, given.count, given.loose))
            return 0
        with sys.stdin.buffer if given.file == "-" else open(given.file, "rb") as stream:
            if given.verb == "refusal":
                output.write(refusal(stream, not given.basic).encode() + b"\n")
            else:
                show_messages(given.verb, stream, not given.basic, output)
    except Refused as refused:
        print(refused, file=sys.stderr)
        return 1
    except BrokenPipeError:  # whoever reads has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), output.fileno())
    except OSError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
