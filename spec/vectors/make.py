#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the test vectors of MTP/1. Bytes and results are stated by hand; nothing here reads a message.

    python3 make.py           write valid/ and invalid/
    python3 make.py --check   tell whether the files are what this program writes
"""

import json
import pathlib
import struct
import sys

HERE = pathlib.Path(__file__).parent
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

# Every matrix type, in text and in binary.
good("position", message(H % (10390, 3, 1, 1), "0.12 -0.05 1.25", "[[[0.12,-0.05,1.25]]]"))
good("position_path", message(H % (10390, 1, 1, 3), "0 0 0\n1 0.5 0\n2 1 0.25",
     "[[[0,0,0]],[[1,0.5,0]],[[2,1,0.25]]]"))
good("position_9", message(H % (10990, 1, 1, 1), "1 2 3 0.1 0.2 0.3 0 0 -9.81",
     "[[[1,2,3,0.1,0.2,0.3,0,0,-9.81]]]"))
good("position_6_f32", message(H % (10680, 1, 1, 1), "1 2 3 0.1 0.2 0.3", "[[[1,2,3,0.1,0.2,0.3]]]"))
good("position_binary", message(H % (10391, 3, 1, 1), struct.pack("<3d", 0.12, -0.05, 1.25),
     "[[[0.12,-0.05,1.25]]]"))
good("rotation", message(H % (20390, 13, 1, 1), "0 -0.1 1.5", "[[[0,-0.1,1.5]]]"))
good("rotation_6", message(H % (20680, 13, 1, 1), "0 -0.1 1.5 0.01 0 0", "[[[0,-0.1,1.5,0.01,0,0]]]"))
good("rgb_image", message(H % (30301, 7, 2, 1), bytes([255, 0, 0, 0, 0, 255]), "[[[255,0,0],[0,0,255]]]"))
good("rgb_image_text", message(H % (30300, 7, 2, 2), "255 0 0 0 255 0\n0 0 255 7 8 9",
     "[[[255,0,0],[0,255,0]],[[0,0,255],[7,8,9]]]"))
good("rgba_image", message(H % (30401, 7, 1, 2), bytes(range(8)), "[[[0,1,2,3]],[[4,5,6,7]]]"))
good("rgb_image_u16", message(H % (30321, 7, 1, 1), struct.pack("<3H", 0, 1000, 65535), "[[[0,1000,65535]]]"))
good("rgb_image_f32", message(H % (30381, 7, 1, 1), struct.pack("<3f", 0, 0.5, 1), "[[[0,0.5,1]]]"))
good("intensity_image", message(H % (40101, 7, 3, 2), bytes([0, 1, 2, 253, 254, 255]), "[[0,1,2],[253,254,255]]"))
good("depth_image", message(H % (40181, 11, 2, 1), struct.pack("<2f", 0, 1.5), "[[0,1.5]]"))
good("vector_field", message(H % (50280, 9, 2, 2), "1 0 0 1\n-1 0 0 -1", "[[[1,0],[0,1]],[[-1,0],[0,-1]]]"))
good("vector_field_99", message(H % (59900, 0, 1, 1), " ".join(str(i) for i in range(99)),
     "[[[" + ",".join(str(i) for i in range(99)) + "]]]"))
good("string", message(H % (60100, 30, 5, 1), "hello", '["hello"]'))
good("string_binary", message(H % (60101, 30, 5, 1), "hello", '["hello"]'))
good("transformation_pose", message(H % (70190, 1003, 4, 4), "1 0 0 0.1\n0 1 0 0\n0 0 1 1.2\n0 0 0 1",
     "[[1,0,0,0.1],[0,1,0,0],[0,0,1,1.2],[0,0,0,1]]"))
good("transformation_projection", message(H % (70190, 7004, 4, 3), "800 0 400 0\n0 800 300 0\n0 0 1 0",
     "[[800,0,400,0],[0,800,300,0],[0,0,1,0]]"))
good("dense_graph", message(H % (80180, 40, 2, 2), "0 0.5\n0.25 0", "[[0,0.5],[0.25,0]]"))
good("sparse_graph", message(H % (90350, 40, 1, 2), "0 1 7\n1 0 -7", "[[[0,1,7]],[[1,0,-7]]]"))
good("sound_stereo", message(H % (100231, 23, 2, 1), struct.pack("<4h", -32768, 32767, 0, 1), "[[[-32768,32767],[0,1]]]"))
good("sound_mono_text", message(H % (100130, 20, 3, 1), "-1 0 1", "[[-1,0,1]]"))
good("map", message(H % (110110, 1, 3, 2), "0 -1 100\n0 0 -128", "[[0,-1,100],[0,0,-128]]"))
good("table", message(H % (120170, 40, 2, 1), "12 -3", "[[12,-3]]"))

# Every scalar with the extremes of its range.
for i, (scalar, letter, least, most) in enumerate([
    ("u8", "B", 0, 255), ("i8", "b", -128, 127), ("u16", "H", 0, 65535), ("i16", "h", -32768, 32767),
    ("u32", "I", 0, 4294967295), ("i32", "i", -2147483648, 2147483647),
    ("u64", "Q", 0, 18446744073709551615), ("i64", "q", -9223372036854775808, 9223372036854775807)]):
    good("scalar_%s_text" % scalar, message(H % (120100 + 10 * i, 40, 3, 1), "%d 1 %d" % (least, most), "[[%d,1,%d]]" % (least, most)))
    good("scalar_%s_binary" % scalar, message(H % (120101 + 10 * i, 40, 3, 1), struct.pack("<3" + letter, least, 1, most), "[[%d,1,%d]]" % (least, most)))
good("scalar_f32_text", message(H % (120180, 40, 4, 1), "3.4028235e+38 -3.4028235e+38 1e-45 1.1754944e-38",
     "[[3.4028235e+38,-3.4028235e+38,1e-45,1.1754944e-38]]"))
good("scalar_f32_binary", message(H % (120181, 40, 3, 1), bytes.fromhex("ffff7f7f" "01000000" "cdcccc3d"), "[[3.4028235e+38,1e-45,0.1]]"))
good("scalar_f64_text", message(H % (120190, 40, 3, 1), "1.7976931348623157e+308 5e-324 2.2250738585072014e-308",
     "[[1.7976931348623157e+308,5e-324,2.2250738585072014e-308]]"))
good("scalar_f64_binary", message(H % (120191, 40, 2, 1), bytes.fromhex("ffffffffffffef7f" "0100000000000000"), "[[1.7976931348623157e+308,5e-324]]"))

# Spelling of floats (R39).
good("float_specials", message(H % (120190, 40, 5, 1), "nan inf -inf -0 0", '[["nan","inf","-inf",-0,0]]'))
good("float_specials_binary", message(H % (120181, 40, 4, 1), bytes.fromhex("0000c0ff" "0000807f" "000080ff" "00000080"),
     '[["nan","inf","-inf",-0]]'))
good("float_nan_payload", message(H % (120191, 40, 1, 1), bytes.fromhex("010000000000f47f"), '[["nan"]]'))
good("float_notation", message(H % (120190, 40, 9, 1), "0.1 100 10000 1e+05 12345 123456 0.001 1e-04 1.5e-07",
     "[[0.1,100,10000,1e+05,12345,123456,0.001,1e-04,1.5e-07]]"))
good("float_large_whole", message(H % (120190, 40, 5, 1), "9007199254740992 1e+22 123456789012345680 1234567890123456774144 1.2345678901234568e+22",
     "[[9007199254740992,1e+22,123456789012345680,1234567890123456774144,1.2345678901234568e+22]]"))
good("float_shortest", message(H % (120191, 40, 3, 1), struct.pack("<3d", 0.1 + 0.2, 1 / 3, 100.5),
     "[[0.30000000000000004,0.3333333333333333,100.5]]"))
good("float_f32_shortest", message(H % (120181, 40, 3, 1), struct.pack("<3f", 0.1, 1 / 3, 16777216.0), "[[0.1,0.33333334,16777216]]"))
good("float_spellings_loose", message(H % (120190, 40, 9, 1), "0.10 1e2 1E+3 .5 2. 00.5 -0.0 NaN -Infinity",
     '[[0.1,100,1000,0.5,2,0.5,-0,"nan","-inf"]]'))
good("float_rounding_loose", message(H % (120190, 40, 3, 1), "9007199254740993 2.4703282292062328e-324 1e-999",
     "[[9007199254740992,5e-324,0]]"))
# Halfway between two f32 but for a digit that an f64 does not hold: read once, it rounds up.
good("float_f32_once_loose", message(H % (120180, 40, 2, 1), "1.00000005960464477540 7.006492321624086e-46",
     "[[1.0000001,1e-45]]"))
good("float_long_loose", message(H % (120190, 40, 1, 1), "0." + "1" * 62, "[[0.1111111111111111]]"))

# Spelling of headers (R4, R5).
good("header_least", message("1 0 -2147483648 0 0 0 120100 0 0 0 0", "", "[]"))
good("header_most", message("1 2147483647 2147483647 9223372036854775807 255 9223372036854775807 120100 2147483647 2147483647 1 1", "0", "[[0]]"))
good("header_broadcast", message("1 5 -1 0 8 0 120100 0 0 1 1", "0", "[[0]]"))
good("header_group", message("1 5 -17 0 8 0 120100 0 0 1 1", "0", "[[0]]"))
good("header_spaces_loose", message("  1  12   0 1042 8 1763683200123456789 10390 1 3 1 1 ", "0.12  -0.05   1.25", "[[[0.12,-0.05,1.25]]]"))
good("header_crlf_loose", message(H % (10390, 3, 1, 1), "0.12 -0.05 1.25", "[[[0.12,-0.05,1.25]]]", "\r\n"))
good("header_typed_loose", message("1 7 0 1 8 0 10390 1 3 1 1 ", " 0.1 0.2 0.3 ", "[[[0.1,0.2,0.3]]]", "\r\n"))
LINE = "1 7 0 0 8 0 120100 0 0 1 1"
good("header_256_loose", message(LINE + " " * (255 - len(LINE)), "0", "[[0]]"))
good("header_256_crlf_loose", (LINE.encode() + b" " * (254 - len(LINE)) + b"\r\n5\n", twin(LINE, "[[5]]")))
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
EMPTY_ZSTD = bytes.fromhex("28b52ffd240001000099e9d851")
good("empty_zstd", message(H % (120192, 40, 0, 4), b"13\n" + EMPTY_ZSTD, "[]"))

# Strings (R32).
text = "añ→𝄞\u007f"
good("string_utf8", message(H % (60100, 30, len(text.encode()), 1), text, '["' + text + '"]'))
good("string_not_utf8", message(H % (60100, 30, 6, 1), b"a\xff\xc0\x80\xe2\x82", '["a\ufffd\ufffd\ufffd\ufffd\ufffd"]'))
good("string_surrogate", message(H % (60100, 30, 3, 1), b"\xed\xa0\x80", '["\ufffd\ufffd\ufffd"]'))
good("string_escapes", message(H % (60100, 30, 9, 1), b'"\\\n\r\t\x00\x01\x1f/', '["\\"\\\\\\n\\r\\t\\u0000\\u0001\\u001f/"]'))
good("string_rows", message(H % (60100, 30, 3, 2), "onetwo", '["one","two"]'))
good("string_like_header", message(H % (60100, 30, 26, 1), "\n1 7 0 0 8 0 10390 1 3 1 1", '["\\n1 7 0 0 8 0 10390 1 3 1 1"]'))

# Streams (R1) and binary that looks like something else.
good("stream_empty")
good("stream_mixed",
     message("1 1 0 0 8 5 10390 0 3 1 1", "1 2 3", "[[[1,2,3]]]"),
     message("1 2 0 0 8 5 30301 0 7 1 1", b"\n\n\n", "[[[10,10,10]]]"),
     message("1 3 0 0 8 5 60100 0 30 2 1", "hi", '["hi"]'),
     message("1 4 0 0 8 5 120190 0 40 0 0", "", "[]"),
     message("1 1 0 1 8 6 10390 0 3 1 1", "4 5 6", "[[[4,5,6]]]"))
good("binary_like_header", message(H % (40101, 7, 27, 1), b"\n1 7 0 0 8 0 10390 1 3 1 1\n",
     "[[" + ",".join(str(c) for c in b"\n1 7 0 0 8 0 10390 1 3 1 1\n") + "]]"))
good("binary_unaligned", message("1 1 0 0 8 0 120191 0 40 1 1", struct.pack("<d", 2.5), "[[2.5]]"),
     message("1 1 0 10 8 0 120191 0 40 1 1", struct.pack("<d", 3.5), "[[3.5]]"),
     message("1 1 0 100 8 0 120191 0 40 1 1", struct.pack("<d", 4.5), "[[4.5]]"))

# Compressed (R34 … R37). The parts were made once with zstd 1.5 and cjpeg 2.1.
ZSTD_POSITION = bytes.fromhex("28b52ffd0468c10000b81e85eb51b8be3f9a9999999999a9bf000000000000f43f500d6106")
ZSTD_ZEROS = bytes.fromhex("28b52ffd046845000008000100e42b20045a074479")
ZSTD_TEXT = bytes.fromhex(
    "28b52ffd0068150300f2c40e11b0b901046189ada422d9dd9b24c88531ab675edc55ddc4e4ff3f1547d19c9888daad"
    "3f863bbef65524eaf5cfd44106923ac89619c5c8b160eaa01da81038dbfdcfc0e38c0110fe1121a90764339280bf6cf5"
    "f3ce7ddb53d88600d07587a4")
ZSTD_7, ZSTD_8 = bytes.fromhex("28b52ffd005809000007"), bytes.fromhex("28b52ffd005809000008")
JPEG_GREY = bytes.fromhex(
    "ffd8ffe000104a46494600010100000100010000ffdb004300" + "01" * 64 +
    "ffc0000b080002000301011100ffc40014000100000000000000000000000000000000ffc4001410010000000000000000"
    "0000000000000000ffda0008010100003f003fffd9")
JPEG_PROGRESSIVE = bytes.fromhex(
    "ffd8ffe000104a46494600010100000100010000ffdb0043000302020302020303030304030304050805050404050a0707"
    "06080c0a0c0c0b0a0b0b0d0e12100d0e110e0b0b1016101113141515150c0f171816141812141514ffc2000b0800080010"
    "01011100ffc4001500010100000000000000000000000000000007ffda0008010100000001b03fffc4001410010000000000"
    "0000000000000000000010ffda00080101000105023fffc40014100100000000000000000000000000000010ffda000801"
    "0100063f023fffc40014100100000000000000000000000000000010ffda0008010100013f213fffda0008010100000010"
    "3fffc40014100100000000000000000000000000000010ffda0008010100013f103fffd9")
JPEG_COLOUR = bytes.fromhex(
    "ffd8ffe000104a46494600010100000100010000ffdb004300" + "01" * 64 + "ffdb004301" + "01" * 64 +
    "ffc00011080002000203011100021101031101ffc40014000100000000000000000000000000000009ffc4001410010000"
    "0000000000000000000000000000ffc40014010100000000000000000000000000000000ffc400141101000000000000000000"
    "00000000000000ffda000c03010002110311003f0033c1ffd9")


def part(data):
    return b"%d\n" % len(data) + data


good("zstd", message(H % (10392, 3, 1, 1), part(ZSTD_POSITION), "[[[0.12,-0.05,1.25]]]"))
good("zstd_zeros", message(H % (40102, 7, 100, 10), part(ZSTD_ZEROS), "[" + ",".join(["[" + ",".join(["0"] * 100) + "]"] * 10) + "]"))
rows = "".join("row %d of many rows, " % (i * i) for i in range(30))
good("zstd_string", message(H % (60102, 30, len(rows), 1), part(ZSTD_TEXT), '["' + rows + '"]'))
good("zstd_two_frames", message(H % (40102, 7, 2, 1), part(ZSTD_7 + ZSTD_8), "[[7,8]]"))
good("jpeg_grey", message(H % (40103, 7, 3, 2), part(JPEG_GREY), "[[128,128,128],[128,128,128]]"))
good("jpeg_progressive", message(H % (40103, 7, 16, 8), part(JPEG_PROGRESSIVE), "[" + ",".join(["[" + ",".join(["200"] * 16) + "]"] * 8) + "]"))
good("jpeg_colour", message(H % (30303, 7, 2, 2), part(JPEG_COLOUR), "[[[90,90,90],[90,90,90]],[[90,90,90],[90,90,90]]]"))

# ---- What is refused. ----

T = "1 7 0 0 8 0 "  # version … time
P = T + "10390 1 3 1 1\n"  # a position's header
ONE = P + "0.1 0.2 0.3\n"  # a whole message

for name, cut in [("in_header", P[:9]), ("before_lf", P[:-1]), ("after_header", P), ("in_row", P + "0.1 0.2"),
                  ("before_closing", P + "0.1 0.2 0.3"), ("binary", T + "40101 1 7 3 1\nab"),
                  ("binary_closing", T + "40101 1 7 3 1\nabc"), ("empty_closing", T + "120190 0 40 0 0\n"),
                  ("length_line", T + "40102 1 7 1 1\n1"), ("compressed", T + "40102 1 7 1 1\n10\nabc"),
                  ("large_promise", T + "40101 1 7 16384 16384\nabc"), ("second_row", T + "40100 1 7 1 2\n1\n"),
                  ("bad_header", "2 x")]:
    bad("R2_" + name, "R2", "stream", cut, "")
bad("R2_second_message", "R2", "stream", ONE + P + "0.1", "", 1)
bad("R2_third_message", "R2", "stream", ONE + ONE + "1 7", "", 2)
bad("R3_no_line_feed", "R3", "header", "1" * 256, "1" * 300)
bad("R3_10000_digits", "R3", "header", ("1 7 0 " + "9" * 10000)[:256], "9" * 9800 + " 8 0 10390 1 3 1 1\n")
bad("R3_257_bytes", "R3", "header", T + "120100 0 0 1 1" + " " * (256 - len(T) - 14), "\n0\n")
bad("R3_second_message", "R3", "header", ONE + "1" * 256, "\n", 1)
bad("R4_ten_fields", "R4", "height", P[:-3], "\n0.1 0.2 0.3\n")
bad("R4_twelve_fields", "R4", "header", P[:-1] + " ", "9\n0.1 0.2 0.3\n")
bad("R4_one_field", "R4", "src", "1", "\n")
bad("R4_blank_line", "R4", "version", "", "\n")
bad("R4_blank_between", "R4", "version", ONE, "\n" + ONE, 1)
bad("R4_spaces_alone", "R4", "version", "   ", "\n")
bad("R4_missing_crlf", "R4", "height", P[:-3], "\r\n")
bad("R4_trailing_space_missing", "R4", "height", P[:-2], "\n")
bad("R4_extra_before_size", "R4", "header", T + "40101 1 7 2147483647 2147483647 ", "5\n")
for name, before, rest in [
    ("hex", "1 ", "0x7 0 0 8 0 10390 1 3 1 1\n"), ("nul", "1 7 ", "\0 0 8 0 10390 1 3 1 1\n"),
    ("plus", "1 ", "+7 0 0 8 0 10390 1 3 1 1\n"), ("leading_zero", "1 ", "07 0 0 8 0 10390 1 3 1 1\n"),
    ("float", "1 ", "7.0 0 0 8 0 10390 1 3 1 1\n"), ("comma", "1 ", "7, 0 0 8 0 10390 1 3 1 1\n"),
    ("word", "", "GET / HTTP/1.1\n"), ("minus_alone", "1 ", "- 0 0 8 0 10390 1 3 1 1\n"),
]:
    bad("R5_" + name, "R5", "src" if before == "1 " else "dst" if before else "version", before, rest)
bad("R5_tab", "R5", "version", "", "1\t7 0 0 8 0 10390 1 3 1 1\n")
bad("R5_minus_zero", "R5", "dst", "1 7 ", "-0 0 8 0 10390 1 3 1 1\n")
bad("R5_cr_inside", "R5", "height", P[:-2], "1\r \n")
bad("R5_utf8_digit", "R5", "ttl", "1 7 0 0 ", "\u0668 0 10390 1 3 1 1\n")
bad("R5_double_minus", "R5", "dst", "1 7 ", "--1 0 8 0 10390 1 3 1 1\n")
bad("R6_version_2", "R6", "version", "", "2 7 0 0 8 0 10390 1 3 1 1\n")
bad("R6_version_0", "R6", "version", "", "0 7 0 0 8 0 10390 1 3 1 1\n")
bad("R6_before_rest", "R6", "version", "", "2 what else\n")
bad("R6_huge", "R6", "version", "", "1" * 200 + "\n")
bad("R7_negative", "R7", "src", "1 ", "-1 0 0 8 0 10390 1 3 1 1\n")
bad("R7_above", "R7", "src", "1 ", "2147483648 0 0 8 0 10390 1 3 1 1\n")
bad("R8_below", "R8", "dst", "1 7 ", "-2147483649 0 8 0 10390 1 3 1 1\n")
bad("R8_above", "R8", "dst", "1 7 ", "2147483648 0 8 0 10390 1 3 1 1\n")
bad("R9_negative", "R9", "seq", "1 7 0 ", "-1 8 0 10390 1 3 1 1\n")
bad("R9_2_to_63", "R9", "seq", "1 7 0 ", "9223372036854775808 8 0 10390 1 3 1 1\n")
bad("R9_200_digits", "R9", "seq", "1 7 0 ", "9" * 200 + " 8 0 10390 1 3 1 1\n")
bad("R10_above", "R10", "ttl", "1 7 0 0 ", "256 0 10390 1 3 1 1\n")
bad("R10_negative", "R10", "ttl", "1 7 0 0 ", "-8 0 10390 1 3 1 1\n")
bad("R11_negative", "R11", "time", "1 7 0 0 8 ", "-1 10390 1 3 1 1\n")
bad("R11_above", "R11", "time", "1 7 0 0 8 ", "10000000000000000000 10390 1 3 1 1\n")
bad("R12_negative", "R12", "info", T, "-10390 1 3 1 1\n")
bad("R12_above", "R12", "info", T, "2147483648 1 3 1 1\n")
bad("R13_negative", "R13", "mode", T + "10390 ", "-1 3 1 1\n")
bad("R14_above", "R14", "coord", T + "10390 1 ", "2147483648 1 1\n")
bad("R15_negative", "R15", "width", T + "10390 1 3 ", "-1 1\n")
bad("R15_2_to_63", "R15", "width", T + "40101 1 7 ", "9223372036854775808 1\n")
bad("R16_negative", "R16", "height", T + "10390 1 3 1 ", "-1\n")
bad("R16_above", "R16", "height", T + "10390 1 3 1 ", "2147483648\n")
for name, info in [("none", 0), ("one_digit", 7), ("13", 130390), ("zero", 9999), ("large", 2147483647)]:
    bad("R17_" + name, "R17", "info", T, "%d 1 3 1 1\n" % info)
for name, info in [("position_4", 10490), ("position_0", 10090), ("rgb_1", 30101), ("rgb_5", 30501), ("intensity_3", 40301),
                   ("string_2", 60200), ("transformation_3", 70390), ("sparse_graph_1", 90180), ("table_0", 120090)]:
    bad("R18_" + name, "R18", "info", T, "%d 1 3 1 1\n" % info)
for name, info in [("position_u8", 10300), ("rotation_i32", 20350), ("rgb_i8", 30311), ("string_f64", 60190), ("transformation_i64", 70170)]:
    bad("R19_" + name, "R19", "info", T, "%d 1 3 1 1\n" % info)
for encoding in range(4, 10):
    bad("R20_encoding_%d" % encoding, "R20", "info", T, "%d 1 7 2 2\n" % (30300 + encoding))
for name, info in [("u16", 30323), ("rgba", 30403), ("table", 120103), ("position", 10393)]:
    bad("R21_" + name, "R21", "info", T, "%d 1 7 2 2\n" % info)
bad("R21_width_0", "R21", "width", T + "40103 1 7 ", "0 1\n")
bad("R21_height_0", "R21", "height", T + "40103 1 7 1 ", "0\n")
bad("R21_width_65501", "R21", "width", T + "40103 1 7 ", "65501 1\n")
bad("R22_width_2", "R22", "width", T + "90280 1 40 ", "2 5\n")
bad("R22_width_0", "R22", "width", T + "90280 1 40 ", "0 5\n")
bad("R23_not_square", "R23", "height", T + "80180 1 40 3 ", "4\n")
bad("R23_0x1", "R23", "height", T + "80180 1 40 0 ", "1\n")
bad("R24_product", "R24", "width", T + "30301 1 7 ", "2147483647 2147483647\n")
bad("R24_wraps_to_0", "R24", "width", T + "120191 1 40 ", "1073741824 2147483647\n")
bad("R24_wraps_to_small", "R24", "width", T + "123290 1 40 ", "268435456 268435456\n")
bad("R24_one_over", "R24", "width", T + "40101 1 7 ", "268435457 1\n")
bad("R24_components", "R24", "width", T + "59991 1 7 ", "342393 1\n")
bad("R24_compressed", "R24", "width", T + "40102 1 7 ", "268435457 1\n5\nabcde\n")

bad("R26_binary", "R26", "elements", T + "40101 1 7 2 1\nAB", "C")
bad("R26_binary_crlf", "R26", "elements", T + "40101 1 7 2 1\nAB", "\r\n")
bad("R26_string_short_promise", "R26", "elements", T + "60100 1 30 4 1\nhell", "o\n")
bad("R26_empty", "R26", "elements", T + "120190 1 40 0 0\n", "0\n")
bad("R26_empty_next_header", "R26", "elements", T + "120190 1 40 0 0\n", ONE)
bad("R26_string_cr_alone", "R26", "elements", T + "60100 1 30 2 1\nok", "\rx\n")
bad("R26_before_R36", "R26", "elements", T + "40102 1 7 2 1\n3\nabc", "d\n")
bad("R26_before_R37", "R26", "elements", T + "40103 1 7 2 1\n3\nabc", "d\n")
for name, number in [("plus", "+0.2"), ("word", "two"), ("hex", "0x1p3"), ("comma", "0,2"), ("two_points", "0.2.3"),
                     ("exponent_cut", "1e"), ("point_alone", "."), ("minus_alone", "-"), ("nan_payload", "nan(1)"), ("nul", "0\0"),
                     ("tab", "0.2\t0.3"), ("infinit", "infinit"), ("underscore", "1_0"), ("sign_in_middle", "1-2"), ("double_minus", "--1")]:
    bad("R27_" + name, "R27", "elements", P + "0.1 ", number + " 0.3\n")
bad("R27_float_for_int", "R27", "elements", T + "40100 1 7 2 1\n7 ", "8.0\n")
bad("R27_leading_zero", "R27", "elements", T + "40100 1 7 2 1\n7 ", "08\n")
bad("R27_minus_zero", "R27", "elements", T + "120110 1 40 2 1\n7 ", "-0\n")
bad("R27_cr_inside", "R27", "elements", T + "40100 1 7 2 1\n7 ", "8\r9\n")
for i, (scalar, number) in enumerate([("u8", 256), ("i8", -129), ("u16", 65536), ("i16", 32768), ("u32", 4294967296),
                                      ("i32", -2147483649), ("u64", 18446744073709551616), ("i64", 9223372036854775808)]):
    bad("R28_" + scalar, "R28", "elements", T + "%d 1 40 2 1\n7 " % (120100 + 10 * i), "%d\n" % number)
bad("R28_u8_negative", "R28", "elements", T + "40100 1 7 2 1\n7 ", "-1\n")
bad("R28_u64_negative", "R28", "elements", T + "120160 1 40 2 1\n7 ", "-20000000000000000000\n")
bad("R28_f32", "R28", "elements", T + "120180 1 40 2 1\n7 ", "3.5e38\n")
bad("R28_f64", "R28", "elements", T + "120190 1 40 2 1\n7 ", "-1e309\n")
bad("R28_f64_long_exponent", "R28", "elements", T + "120190 1 40 2 1\n7 ", "1e99999999999999999999\n")
bad("R29_two_of_three", "R29", "elements", P + "0.1 0.2", "\n")
bad("R29_none", "R29", "elements", P, "\n")
bad("R29_trailing_space", "R29", "elements", P + "0.1 0.2 ", "\n")
bad("R29_crlf", "R29", "elements", P + "0.1 0.2", "\r\n")
bad("R29_second_row", "R29", "elements", T + "40100 1 7 2 2\n1 2\n3", "\n4\n")
bad("R30_four_of_three", "R30", "elements", P + "0.1 0.2 0.3 ", "0.4\n")
bad("R30_first_row", "R30", "elements", T + "40100 1 7 2 2\n1 2 ", "3 4\n")
bad("R30_before_R27", "R30", "elements", P + "0.1 0.2 0.3 ", "what\n")
bad("R31_65_bytes", "R31", "elements", P + "0.1 ", "0." + "1" * 63 + " 0.3\n")
bad("R31_before_R30", "R31", "elements", P + "0.1 0.2 0.3 ", "9" * 65 + "\n")
bad("R31_before_R27", "R31", "elements", P + "0.1 ", "x" * 65 + " 0.3\n")
bad("R31_1000_digits", "R31", "elements", T + "120160 1 40 1 1\n", "1" * 1000 + "\n")

Z = T + "40102 1 7 2 1\n"
for name, line in [("word", "ten\n"), ("negative", "-3\n"), ("plus", "+3\n"), ("leading_zero", "03\n"), ("blank", "\n"),
                   ("space", "3 \n"), ("crlf", "3\r\n"), ("no_line_feed", "1" * 21), ("data_at_once", "\x28\xb5\n")]:
    bad("R34_" + name, "R34", "length", Z, line.encode("latin-1") + b"abc\n")
bad("R35_one_over", "R35", "length", Z, "268435457\nabc\n")
bad("R35_2_to_64", "R35", "length", Z, "18446744073709551616\nabc\n")


def zstd(name, data, width=2):
    before = b"%s40102 1 7 %d 1\n%d\n" % (T.encode(), width, len(data))
    bad("R36_" + name, "R36", "elements", before, data + b"\n")


zstd("garbage", b"abcdefgh")
zstd("nothing", b"")
zstd("holds_less", ZSTD_7)
zstd("holds_more", ZSTD_7 + ZSTD_8 + ZSTD_7)
zstd("bomb_1000", ZSTD_ZEROS)
zstd("cut", ZSTD_7[:-1])
zstd("garbage_behind", ZSTD_7 + ZSTD_8 + b"x")
zstd("checksum", ZSTD_ZEROS[:-1] + b"\x00", 1000)
# A frame without a size whose blocks each repeat one byte 128 KiB long: 100 MiB out of 3 KiB.
BLOCK = (131072 << 3) | (1 << 1)
frame = bytes.fromhex("28b52ffd") + bytes([0x00, 0x38])
frame += (struct.pack("<I", BLOCK)[:3] + b"\0") * 799 + struct.pack("<I", BLOCK | 1)[:3] + b"\0"
zstd("bomb_100_MiB", frame, 1)


def jpeg(name, data, info=40103, width=3, height=2):
    before = b"%s%d 1 7 %d %d\n%d\n" % (T.encode(), info, width, height, len(data))
    bad("R37_" + name, "R37", "elements", before, data + b"\n")


jpeg("garbage", b"abcdefgh")
jpeg("nothing", b"")
jpeg("other_width", JPEG_GREY, width=2)
jpeg("other_height", JPEG_GREY, height=3)
jpeg("other_components", JPEG_GREY, info=30303)
jpeg("colour_for_grey", JPEG_COLOUR, width=2)
jpeg("cut_in_header", JPEG_GREY[:60])
jpeg("cut_before_scan", JPEG_GREY[:-14])
jpeg("bytes_behind", JPEG_GREY + b"xyz")
bad("R7_third_message", "R7", "src", ONE + ONE + "1 ", "-1 0 0 8 0 10390 1 3 1 1\n", 2)


def files():
    for folder, cases in (("valid", valid), ("invalid", invalid)):
        for name, (data, result) in cases.items():
            yield HERE / folder / (name + ".mtp"), data
            yield HERE / folder / (name + ".json"), result.encode()


def main():
    wanted = dict(files())
    present = set(HERE.glob("*valid/*"))
    if "--check" in sys.argv[1:]:
        wrong = [p for p, data in wanted.items() if p not in present or p.read_bytes() != data]
        wrong += sorted(present - set(wanted))
        for path in wrong:
            print("%s is not as make.py writes it" % path.relative_to(HERE))
        print("%d valid, %d invalid vectors" % (len(valid), len(invalid)))
        return 1 if wrong else 0
    for path in present - set(wanted):
        path.unlink()
    for path, data in wanted.items():
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(data)
    return 0


if __name__ == "__main__":
    sys.exit(main())
