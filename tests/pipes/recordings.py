# SPDX-License-Identifier: Apache-2.0
"""The messages of a recording."""

import pathlib
from collections import namedtuple

COMPONENT_BYTES = {0: 1, 2: 2, 3: 2, 8: 4, 9: 8}  # of u8, i16, u16, f32, f64

# `fixed` are dst, info, mode, coord, width and height; src and seq are not kept.
Message = namedtuple("Message", "time fixed elements")


def read_messages(path):
    """The messages of a recording, in its order."""
    data = pathlib.Path(path).read_bytes()
    found, at = [], 0
    while at < len(data):
        end = data.index(b"\n", at)
        header = [int(word) for word in data[at:end].split()]
        info, width, height = header[6], header[9], header[10]
        # The size of the elements is known where they are binary, else they are text.
        if info % 10 == 1:
            stop = end + 1 + width * height * (info // 100 % 100) * COMPONENT_BYTES[info // 10 % 10]
        else:
            stop = end
            for _ in range(height):
                stop = data.index(b"\n", stop + 1)
        fixed = (header[2], info) + tuple(header[7:])
        found.append(Message(header[5], fixed, data[end:stop]))
        at = stop + 1
    return found
