# SPDX-License-Identifier: Apache-2.0
"""Expands compressed elements with the programs zstd and djpeg; ValueError where they are refused."""

import re
import subprocess
import tempfile

ZSTD_FRAME = re.compile(rb"\x28\xb5\x2f\xfd|[\x50-\x5f]\x2a\x4d\x18")
MARKER = re.compile(rb"\xff+([\x01-\xfe])", re.S)
# What ends a scan: neither a restart nor a byte of data, which a zero follows. ITU-T T.81, B.1.1
SCAN_END = re.compile(rb"\xff+([\x01-\xcf\xd8-\xfe])", re.S)
FRAMES = {*range(0xC0, 0xD0)} - {0xC4, 0xC8, 0xCC}
HUFFMAN_FRAMES = (0xC0, 0xC1, 0xC2)


def run(data, most, *command):
    """What a program makes of bytes; no more than `most` bytes are read of it."""
    with tempfile.TemporaryFile() as given:
        given.write(data)
        given.seek(0)
        with subprocess.Popen(command, stdin=given, stdout=-1, stderr=-3) as process:
            made = process.stdout.read(most + 1)
            process.stdout.close()
    if len(made) > most:
        raise ValueError(f"{command[0]} makes more than {most} bytes")
    if process.returncode:
        raise ValueError(f"{command[0]} refuses it")
    return made


def expand_zstd(data, size):
    """The content of one or more whole frames, which is of `size` bytes. RFC 8878, 3.1"""
    if not ZSTD_FRAME.match(data):  # the program knows other formats too
        raise ValueError("no zstd frame")
    made = run(data, size, "zstd", "-dcq", "--long=31")
    if len(made) != size:
        raise ValueError(f"zstd holds {len(made)} bytes, not {size}")
    return made


def expand_jpeg(data, width, height, components):
    """The samples of an image that is of just this shape, and nothing behind it."""
    check_segments(data, components)
    head = b"P%d\n%d %d\n255\n" % (6 if components == 3 else 5, width, height)
    size = width * height * components
    made = run(data, len(head) + size, "djpeg", "-pnm")
    if len(made) != len(head) + size or not made.startswith(head):
        raise ValueError(f"not an image {width}x{height} of {components} components")
    return made[len(head) :]


def check_segments(data, components):
    """Refuses an image of another kind or of other components, and bytes behind it. T.81, B.2"""
    at = 2
    while found := MARKER.match(data, at):
        at, marker = found.end(), found[1][0]
        if marker in FRAMES and marker not in HUFFMAN_FRAMES:
            raise ValueError("neither sequential nor progressive Huffman")
        if marker in FRAMES and data[at + 7 : at + 8] != bytes([components]):
            raise ValueError(f"not {components} components")
        if marker == 0xD9:
            break
        at += int.from_bytes(data[at : at + 2], "big")
        if marker == 0xDA and (found := SCAN_END.search(data, at)):
            at = found.start()
    if at < len(data):
        raise ValueError("bytes behind the image")
