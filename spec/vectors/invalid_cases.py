# SPDX-License-Identifier: Apache-2.0
"""Streams that a reader refuses: bad(name, rule, field, what stands before, the rest, messages)."""

from cases import ONE, P, T, bad
from parts import *

for name, cut in [
    ("in_header", P[:9]),
    ("before_lf", P[:-1]),
    ("after_header", P),
    ("in_row", P + "0.1 0.2"),
    ("before_closing", P + "0.1 0.2 0.3"),
    ("binary", T + "40101 1 7 3 1\nab"),
    ("binary_closing", T + "40101 1 7 3 1\nabc"),
    ("empty_closing", T + "120190 0 40 0 0\n"),
    ("length_line", T + "40102 1 7 1 1\n1"),
    ("compressed", T + "40102 1 7 1 1\n10\nabc"),
    ("large_promise", T + "40101 1 7 16384 16384\nabc"),
    ("second_row", T + "40100 1 7 1 2\n1\n"),
    ("bad_header", "2 x"),
]:
    bad("R2_" + name, "R2", "stream", cut, "")
bad("R2_second_message", "R2", "stream", ONE + P + "0.1", "", 1)
bad("R2_third_message", "R2", "stream", ONE + ONE + "1 7", "", 2)
bad("R3_no_line_feed", "R3", "header", "1" * 256, "1" * 300)
bad(
    "R3_10000_digits",
    "R3",
    "header",
    ("1 7 0 " + "9" * 10000)[:256],
    "9" * 9800 + " 8 0 10390 1 3 1 1\n",
)
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
    ("hex", "1 ", "0x7 0 0 8 0 10390 1 3 1 1\n"),
    ("nul", "1 7 ", "\0 0 8 0 10390 1 3 1 1\n"),
    ("plus", "1 ", "+7 0 0 8 0 10390 1 3 1 1\n"),
    ("leading_zero", "1 ", "07 0 0 8 0 10390 1 3 1 1\n"),
    ("float", "1 ", "7.0 0 0 8 0 10390 1 3 1 1\n"),
    ("comma", "1 ", "7, 0 0 8 0 10390 1 3 1 1\n"),
    ("word", "", "GET / HTTP/1.1\n"),
    ("minus_alone", "1 ", "- 0 0 8 0 10390 1 3 1 1\n"),
]:
    bad(
        "R5_" + name,
        "R5",
        "src" if before == "1 " else "dst" if before else "version",
        before,
        rest,
    )
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
for name, info in [
    ("none", 0),
    ("one_digit", 7),
    ("13", 130390),
    ("zero", 9999),
    ("large", 2147483647),
]:
    bad("R17_" + name, "R17", "info", T, "%d 1 3 1 1\n" % info)
for name, info in [
    ("position_4", 10490),
    ("position_0", 10090),
    ("rgb_1", 30101),
    ("rgb_5", 30501),
    ("intensity_3", 40301),
    ("string_2", 60200),
    ("transformation_3", 70390),
    ("sparse_graph_1", 90180),
    ("table_0", 120090),
]:
    bad("R18_" + name, "R18", "info", T, "%d 1 3 1 1\n" % info)
for name, info in [
    ("position_u8", 10300),
    ("rotation_i32", 20350),
    ("rgb_i8", 30311),
    ("string_f64", 60190),
    ("transformation_i64", 70170),
]:
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
# 2 × 8 × 2³⁰ × 2³⁰ = 2⁶⁴, and 5 × 8 × 429509837 × 2147418113 = 2 × 2⁶⁴ + 8: in 64 bits 0 and 8.
bad("R24_wraps_to_0", "R24", "width", T + "120291 1 40 ", "1073741824 1073741824\n\n")
bad("R24_wraps_to_small", "R24", "width", T + "120591 1 40 ", "429509837 2147418113\n12345678\n")
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
for name, number in [
    ("plus", "+0.2"),
    ("word", "two"),
    ("hex", "0x1p3"),
    ("comma", "0,2"),
    ("two_points", "0.2.3"),
    ("exponent_cut", "1e"),
    ("point_alone", "."),
    ("minus_alone", "-"),
    ("nan_payload", "nan(1)"),
    ("nul", "0\0"),
    ("tab", "0.2\t0.3"),
    ("infinit", "infinit"),
    ("underscore", "1_0"),
    ("sign_in_middle", "1-2"),
    ("double_minus", "--1"),
]:
    bad("R27_" + name, "R27", "elements", P + "0.1 ", number + " 0.3\n")
bad("R27_float_for_int", "R27", "elements", T + "40100 1 7 2 1\n7 ", "8.0\n")
bad("R27_leading_zero", "R27", "elements", T + "40100 1 7 2 1\n7 ", "08\n")
bad("R27_minus_zero", "R27", "elements", T + "120110 1 40 2 1\n7 ", "-0\n")
bad("R27_cr_inside", "R27", "elements", T + "40100 1 7 2 1\n7 ", "8\r9\n")
for i, (scalar, number) in enumerate(
    [
        ("u8", 256),
        ("i8", -129),
        ("u16", 65536),
        ("i16", 32768),
        ("u32", 4294967296),
        ("i32", -2147483649),
        ("u64", 18446744073709551616),
        ("i64", 9223372036854775808),
    ]
):
    bad(
        "R28_" + scalar,
        "R28",
        "elements",
        T + "%d 1 40 2 1\n7 " % (120100 + 10 * i),
        "%d\n" % number,
    )
bad("R28_u8_negative", "R28", "elements", T + "40100 1 7 2 1\n7 ", "-1\n")
bad("R28_u64_negative", "R28", "elements", T + "120160 1 40 2 1\n7 ", "-20000000000000000000\n")
bad("R28_f32", "R28", "elements", T + "120180 1 40 2 1\n7 ", "3.5e38\n")
bad("R28_f64", "R28", "elements", T + "120190 1 40 2 1\n7 ", "-1e309\n")
bad(
    "R28_f64_long_exponent",
    "R28",
    "elements",
    T + "120190 1 40 2 1\n7 ",
    "1e99999999999999999999\n",
)
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
for name, line in [
    ("word", "ten\n"),
    ("negative", "-3\n"),
    ("plus", "+3\n"),
    ("leading_zero", "03\n"),
    ("blank", "\n"),
    ("space", "3 \n"),
    ("crlf", "3\r\n"),
    ("no_line_feed", "1" * 21),
    ("data_at_once", "\x28\xb5\n"),
]:
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
zstd("bomb_100_MiB", ZSTD_BOMB, 1)
zstd("size_lie", ZSTD_SIZE_LIE, 1)
zstd("size_huge", ZSTD_SIZE_HUGE, 1)
zstd("reserved_block", ZSTD_RESERVED, 1)


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
jpeg("cut_in_scan", JPEG_NOISE, width=16, height=16)
jpeg("four_components", JPEG_CMYK, info=30303)
jpeg("12_bits", JPEG_12_BITS)
jpeg("arithmetic", JPEG_GREY.replace(b"\xff\xc0", b"\xff\xc9"))
bad("R7_third_message", "R7", "src", ONE + ONE + "1 ", "-1 0 0 8 0 10390 1 3 1 1\n", 2)
