# SPDX-License-Identifier: Apache-2.0
"""Streams that a reader takes: every matrix type, headers, empty matrices, strings, and streams."""

import struct

from cases import H, good, message, twin
from parts import *

# Every matrix type, in text and in binary.
good("position", message(H % (10390, 3, 1, 1), "0.12 -0.05 1.25", "[[[0.12,-0.05,1.25]]]"))
good(
    "position_path",
    message(
        H % (10390, 1, 1, 3), "0 0 0\n1 0.5 0\n2 1 0.25", "[[[0,0,0]],[[1,0.5,0]],[[2,1,0.25]]]"
    ),
)
good(
    "position_9",
    message(
        H % (10990, 1, 1, 1), "1 2 3 0.1 0.2 0.3 0 0 -9.81", "[[[1,2,3,0.1,0.2,0.3,0,0,-9.81]]]"
    ),
)
good(
    "position_6_f32", message(H % (10680, 1, 1, 1), "1 2 3 0.1 0.2 0.3", "[[[1,2,3,0.1,0.2,0.3]]]")
)
good(
    "position_binary",
    message(H % (10391, 3, 1, 1), struct.pack("<3d", 0.12, -0.05, 1.25), "[[[0.12,-0.05,1.25]]]"),
)
good("rotation", message(H % (20390, 13, 1, 1), "0 -0.1 1.5", "[[[0,-0.1,1.5]]]"))
good(
    "rotation_6", message(H % (20680, 13, 1, 1), "0 -0.1 1.5 0.01 0 0", "[[[0,-0.1,1.5,0.01,0,0]]]")
)
good(
    "rgb_image",
    message(H % (30301, 7, 2, 1), bytes([255, 0, 0, 0, 0, 255]), "[[[255,0,0],[0,0,255]]]"),
)
good(
    "rgb_image_text",
    message(
        H % (30300, 7, 2, 2),
        "255 0 0 0 255 0\n0 0 255 7 8 9",
        "[[[255,0,0],[0,255,0]],[[0,0,255],[7,8,9]]]",
    ),
)
good("rgba_image", message(H % (30401, 7, 1, 2), bytes(range(8)), "[[[0,1,2,3]],[[4,5,6,7]]]"))
good(
    "rgb_image_u16",
    message(H % (30321, 7, 1, 1), struct.pack("<3H", 0, 1000, 65535), "[[[0,1000,65535]]]"),
)
good("rgb_image_f32", message(H % (30381, 7, 1, 1), struct.pack("<3f", 0, 0.5, 1), "[[[0,0.5,1]]]"))
good(
    "intensity_image",
    message(H % (40101, 7, 3, 2), bytes([0, 1, 2, 253, 254, 255]), "[[0,1,2],[253,254,255]]"),
)
good("depth_image", message(H % (40181, 11, 2, 1), struct.pack("<2f", 0, 1.5), "[[0,1.5]]"))
good(
    "vector_field",
    message(H % (50280, 9, 2, 2), "1 0 0 1\n-1 0 0 -1", "[[[1,0],[0,1]],[[-1,0],[0,-1]]]"),
)
good(
    "vector_field_99",
    message(
        H % (59900, 0, 1, 1),
        " ".join(str(i) for i in range(99)),
        "[[[" + ",".join(str(i) for i in range(99)) + "]]]",
    ),
)
good("string", message(H % (60100, 30, 5, 1), "hello", '["hello"]'))
good("string_binary", message(H % (60101, 30, 5, 1), "hello", '["hello"]'))
good(
    "transformation_pose",
    message(
        H % (70190, 1003, 4, 4),
        "1 0 0 0.1\n0 1 0 0\n0 0 1 1.2\n0 0 0 1",
        "[[1,0,0,0.1],[0,1,0,0],[0,0,1,1.2],[0,0,0,1]]",
    ),
)
good(
    "transformation_projection",
    message(
        H % (70190, 7004, 4, 3),
        "800 0 400 0\n0 800 300 0\n0 0 1 0",
        "[[800,0,400,0],[0,800,300,0],[0,0,1,0]]",
    ),
)
good("dense_graph", message(H % (80180, 40, 2, 2), "0 0.5\n0.25 0", "[[0,0.5],[0.25,0]]"))
good("dense_graph_directed", message(H % (80150, 40, 2, 2), "0 1\n0 0", "[[0,1],[0,0]]"))
good("sparse_graph_node_alone", message(H % (90250, 40, 1, 2), "0 1\n2 2", "[[[0,1]],[[2,2]]]"))
good("sparse_graph", message(H % (90350, 40, 1, 2), "0 1 7\n1 0 -7", "[[[0,1,7]],[[1,0,-7]]]"))
good(
    "sound_stereo",
    message(
        H % (100231, 23, 2, 1), struct.pack("<4h", -32768, 32767, 0, 1), "[[[-32768,32767],[0,1]]]"
    ),
)
good("sound_mono_text", message(H % (100130, 20, 3, 1), "-1 0 1", "[[-1,0,1]]"))
good("sound_f32", message(H % (100180, 20, 3, 1), "-1 0 1", "[[-1,0,1]]"))
good("map_frame", message(H % (110110, 100, 2, 1), "0 100", "[[0,100]]"))
good(
    "camera_table",
    message(H % (120590, 9, 1, 1), "600 600 400 300 0.13", "[[[600,600,400,300,0.13]]]"),
)
good("set_none_found", message(H % (10390, 7, 0, 1), "", "[]"))
good("map", message(H % (110110, 1, 3, 2), "0 -1 100\n0 0 -128", "[[0,-1,100],[0,0,-128]]"))
good("table", message(H % (120170, 40, 2, 1), "12 -3", "[[12,-3]]"))

# Spelling of headers (R4, R5).
good("header_least", message("1 0 -2147483648 0 0 0 120100 0 0 0 0", "", "[]"))
good(
    "header_most",
    message(
        "1 2147483647 2147483647 9223372036854775807 255 9223372036854775807 120100 2147483647 2147483647 1 1",
        "0",
        "[[0]]",
    ),
)
good("header_broadcast", message("1 5 -1 0 8 0 120100 0 0 1 1", "0", "[[0]]"))
good("header_group", message("1 5 -17 0 8 0 120100 0 0 1 1", "0", "[[0]]"))
good(
    "header_spaces_loose",
    message(
        "  1  12   0 1042 8 1763683200123456789 10390 1 3 1 1 ",
        "0.12  -0.05   1.25",
        "[[[0.12,-0.05,1.25]]]",
    ),
)
good(
    "header_crlf_loose",
    message(H % (10390, 3, 1, 1), "0.12 -0.05 1.25", "[[[0.12,-0.05,1.25]]]", "\r\n"),
)
good(
    "header_typed_loose",
    message("1 7 0 1 8 0 10390 1 3 1 1 ", " 0.1 0.2 0.3 ", "[[[0.1,0.2,0.3]]]", "\r\n"),
)
LINE = "1 7 0 0 8 0 120100 0 0 1 1"
good("header_256_loose", message(LINE + " " * (255 - len(LINE)), "0", "[[0]]"))
good(
    "header_256_crlf_loose",
    (LINE.encode() + b" " * (254 - len(LINE)) + b"\r\n5\n", twin(LINE, "[[5]]")),
)
good("string_crlf_loose", message("1 9 0 0 8 0 60100 0 30 2 1", "ok", '["ok"]', "\r\n"))
good("empty_crlf_loose", message("1 9 0 0 8 0 120190 0 40 0 0", "", "[]", "\r\n"))
good("text_spaces_loose", message(H % (40100, 7, 2, 2), "  1   2 \n3 4", "[[1,2],[3,4]]"))

# Empty matrices (R25), in every encoding that holds them.
good("empty_0x0", message(H % (120190, 40, 0, 0), "", "[]"))
good("empty_0x5", message(H % (120160, 40, 0, 5), "", "[]"))
good("empty_5x0", message(H % (30300, 7, 5, 0), "", "[]"))
good("empty_huge_side", message(H % (40100, 7, 2147483647, 0), "", "[]"))
good("empty_binary", message(H % (40181, 11, 0, 3), b"", "[]"))
good("empty_string", message(H % (60100, 30, 0, 1), "", "[]"))
good("empty_sparse_graph", message(H % (90250, 40, 1, 0), "", "[]"))
good("empty_dense_graph", message(H % (80180, 40, 0, 0), "", "[]"))
good("empty_zstd", message(H % (120192, 40, 0, 4), b"13\n" + EMPTY_ZSTD, "[]"))

# Strings (R32).
text = "añ→𝄞\u007f"
good("string_utf8", message(H % (60100, 30, len(text.encode()), 1), text, '["' + text + '"]'))
good(
    "string_not_utf8",
    message(H % (60100, 30, 6, 1), b"a\xff\xc0\x80\xe2\x82", '["a\ufffd\ufffd\ufffd\ufffd\ufffd"]'),
)
good("string_surrogate", message(H % (60100, 30, 3, 1), b"\xed\xa0\x80", '["\ufffd\ufffd\ufffd"]'))
good(
    "string_escapes",
    message(
        H % (60100, 30, 9, 1),
        b'"\\\n\r\t\x00\x01\x1f/',
        '["\\"\\\\\\n\\r\\t\\u0000\\u0001\\u001f/"]',
    ),
)
good("string_rows", message(H % (60100, 30, 3, 2), "onetwo", '["one","two"]'))
good("string_rows_padded", message(H % (60100, 30, 3, 2), "go at ", '["go ","at "]'))
good("string_width_in_bytes", message(H % (60100, 30, 5, 1), "Grüß"[1:], '["rüß"]'))
good(
    "string_like_header",
    message(
        H % (60100, 30, 26, 1), "\n1 7 0 0 8 0 10390 1 3 1 1", '["\\n1 7 0 0 8 0 10390 1 3 1 1"]'
    ),
)

# Streams (R1) and binary that looks like something else.
good("stream_empty")
good(
    "stream_mixed",
    message("1 1 0 0 8 5 10390 0 3 1 1", "1 2 3", "[[[1,2,3]]]"),
    message("1 2 0 0 8 5 30301 0 7 1 1", b"\n\n\n", "[[[10,10,10]]]"),
    message("1 3 0 0 8 5 60100 0 30 2 1", "hi", '["hi"]'),
    message("1 4 0 0 8 5 120190 0 40 0 0", "", "[]"),
    message("1 1 0 1 8 6 10390 0 3 1 1", "4 5 6", "[[[4,5,6]]]"),
)
good(
    "binary_like_header",
    message(
        H % (40101, 7, 27, 1),
        b"\n1 7 0 0 8 0 10390 1 3 1 1\n",
        "[[" + ",".join(str(c) for c in b"\n1 7 0 0 8 0 10390 1 3 1 1\n") + "]]",
    ),
)
good(
    "binary_unaligned",
    message("1 1 0 0 8 0 120191 0 40 1 1", struct.pack("<d", 2.5), "[[2.5]]"),
    message("1 1 0 10 8 0 120191 0 40 1 1", struct.pack("<d", 3.5), "[[3.5]]"),
    message("1 1 0 100 8 0 120191 0 40 1 1", struct.pack("<d", 4.5), "[[4.5]]"),
)
