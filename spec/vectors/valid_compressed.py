# SPDX-License-Identifier: Apache-2.0
"""Streams that a reader takes: compressed elements (R34 … R37)."""

from cases import H, good, message, part
from parts import *

good("zstd", message(H % (10392, 3, 1, 1), part(ZSTD_POSITION), "[[[0.12,-0.05,1.25]]]"))
good(
    "zstd_zeros",
    message(
        H % (40102, 7, 100, 10),
        part(ZSTD_ZEROS),
        "[" + ",".join(["[" + ",".join(["0"] * 100) + "]"] * 10) + "]",
    ),
)
rows = "".join("row %d of many rows, " % (i * i) for i in range(30))
good("zstd_string", message(H % (60102, 30, len(rows), 1), part(ZSTD_TEXT), '["' + rows + '"]'))
good("zstd_two_frames", message(H % (40102, 7, 2, 1), part(ZSTD_7 + ZSTD_8), "[[7,8]]"))
good("zstd_size_not_given", message(H % (40102, 7, 2, 1), part(ZSTD_AB), "[[97,98]]"))
good(
    "zstd_run",
    message(H % (40102, 7, 300, 1), part(ZSTD_RUN), "[[" + ",".join(["7"] * 300) + "]]"),
)
good("zstd_blocks", message(H % (40102, 7, 5, 1), part(ZSTD_BLOCKS), "[[97,98,99,99,99]]"))
good(
    "zstd_depth_image",
    message(
        H % (40182, 11, 4, 3), part(ZSTD_DEPTH), "[[0,0,0.5,0.5],[1.5,1.5,2.25,2.25],[0,0,0,3]]"
    ),
)
wave = "[0,0],[1000,-1000],[32767,-32768],[1000,-1000]"
good(
    "zstd_sound",
    message(H % (100232, 23, 8, 1), part(ZSTD_SOUND), "[[" + wave + "," + wave + "]]"),
)
good(
    "zstd_i64",
    message(H % (120172, 40, 2, 1), part(ZSTD_I64), "[[-9223372036854775808,9223372036854775807]]"),
)
words = "a stream is a sequence of whole messages and nothing else; " * 9
good(
    "zstd_words",
    message(H % (60102, 30, len(words), 1), part(ZSTD_WORDS), '["' + words + '"]'),
)
good("jpeg_grey", message(H % (40103, 7, 3, 2), part(JPEG_GREY), "[[128,128,128],[128,128,128]]"))
SEQUENTIAL = JPEG_GREY.replace(b"\xff\xc0", b"\xff\xc1")
good(
    "jpeg_extended_sequential",
    message(H % (40103, 7, 3, 2), part(SEQUENTIAL), "[[128,128,128],[128,128,128]]"),
)
good(
    "jpeg_progressive",
    message(
        H % (40103, 7, 16, 8),
        part(JPEG_PROGRESSIVE),
        "[" + ",".join(["[" + ",".join(["200"] * 16) + "]"] * 8) + "]",
    ),
)
good(
    "jpeg_colour",
    message(
        H % (30303, 7, 2, 2), part(JPEG_COLOUR), "[[[90,90,90],[90,90,90]],[[90,90,90],[90,90,90]]]"
    ),
)
row = ",".join(["[114,90,116]"] * 3)
good(
    "jpeg_ycbcr",
    message(H % (30303, 7, 3, 2), part(JPEG_YCBCR), "[[" + row + "],[" + row + "]]"),
)
row = ",".join(["[200,90,40]"] * 3)
good("jpeg_rgb", message(H % (30303, 7, 3, 2), part(JPEG_RGB), "[[" + row + "],[" + row + "]]"))
row = "[" + ",".join(["200"] * 17) + "]"
good(
    "jpeg_restarts",
    message(H % (40103, 7, 17, 9), part(JPEG_RESTARTS), "[" + ",".join([row] * 9) + "]"),
)
