# SPDX-License-Identifier: Apache-2.0
"""Images for notebooks."""

import struct
import zlib
from typing import Any, Optional


def png(message: Any) -> Optional[bytes]:
    """An image message as a PNG file; None for other messages. Images that are not u8 are scaled
    from their minimum to their maximum finite value."""
    import numpy

    if message.type not in ("rgb_image", "intensity_image") or message.matrix.size == 0:
        return None
    pixels = message.matrix
    if pixels.dtype != numpy.uint8:
        known = pixels[numpy.isfinite(pixels)].astype(float)
        low, high = (known.min(), known.max()) if known.size else (0.0, 0.0)
        scaled = (pixels.astype(float) - low) * (255 / (high - low) if high > low else 0)
        pixels = numpy.nan_to_num(scaled, posinf=255, neginf=0).astype(numpy.uint8)
    rows = pixels.reshape(message.height, -1)
    filtered = numpy.zeros((rows.shape[0], rows.shape[1] + 1), numpy.uint8)  # filter 0: none
    filtered[:, 1:] = rows

    def chunk(name: bytes, data: bytes) -> bytes:
        return (
            struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        )

    colour = {1: 0, 3: 2, 4: 6}[message.components]  # grey, RGB, RGBA
    header = struct.pack(">IIBBBBB", message.width, message.height, 8, colour, 0, 0, 0)
    data = zlib.compress(filtered.tobytes(), 1)
    return (
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", data) + chunk(b"IEND", b"")
    )
