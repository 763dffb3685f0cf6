# SPDX-License-Identifier: Apache-2.0
"""Streams that a reader takes: every scalar, and how numbers may be spelled (R39)."""

import struct

from cases import H, good, message

# Every scalar with the extremes of its range.
for i, (scalar, letter, least, most) in enumerate(
    [
        ("u8", "B", 0, 255),
        ("i8", "b", -128, 127),
        ("u16", "H", 0, 65535),
        ("i16", "h", -32768, 32767),
        ("u32", "I", 0, 4294967295),
        ("i32", "i", -2147483648, 2147483647),
        ("u64", "Q", 0, 18446744073709551615),
        ("i64", "q", -9223372036854775808, 9223372036854775807),
    ]
):
    good(
        "scalar_%s_text" % scalar,
        message(
            H % (120100 + 10 * i, 40, 3, 1),
            "%d 1 %d" % (least, most),
            "[[%d,1,%d]]" % (least, most),
        ),
    )
    good(
        "scalar_%s_binary" % scalar,
        message(
            H % (120101 + 10 * i, 40, 3, 1),
            struct.pack("<3" + letter, least, 1, most),
            "[[%d,1,%d]]" % (least, most),
        ),
    )
good(
    "scalar_f32_text",
    message(
        H % (120180, 40, 4, 1),
        "3.4028235e+38 -3.4028235e+38 1e-45 1.1754944e-38",
        "[[3.4028235e+38,-3.4028235e+38,1e-45,1.1754944e-38]]",
    ),
)
good(
    "scalar_f32_binary",
    message(
        H % (120181, 40, 3, 1),
        bytes.fromhex("ffff7f7f" "01000000" "cdcccc3d"),
        "[[3.4028235e+38,1e-45,0.1]]",
    ),
)
good(
    "scalar_f64_text",
    message(
        H % (120190, 40, 3, 1),
        "1.7976931348623157e+308 5e-324 2.2250738585072014e-308",
        "[[1.7976931348623157e+308,5e-324,2.2250738585072014e-308]]",
    ),
)
good(
    "scalar_f64_binary",
    message(
        H % (120191, 40, 2, 1),
        bytes.fromhex("ffffffffffffef7f" "0100000000000000"),
        "[[1.7976931348623157e+308,5e-324]]",
    ),
)

# Spelling of floats (R39).
good(
    "float_specials",
    message(H % (120190, 40, 5, 1), "nan inf -inf -0 0", '[["nan","inf","-inf",-0,0]]'),
)
good(
    "float_specials_binary",
    message(
        H % (120181, 40, 4, 1),
        bytes.fromhex("0000c0ff" "0000807f" "000080ff" "00000080"),
        '[["nan","inf","-inf",-0]]',
    ),
)
good(
    "float_nan_payload",
    message(H % (120191, 40, 1, 1), bytes.fromhex("010000000000f47f"), '[["nan"]]'),
)
good(
    "float_notation",
    message(
        H % (120190, 40, 9, 1),
        "0.1 100 10000 1e+05 12345 123456 0.001 1e-04 1.5e-07",
        "[[0.1,100,10000,1e+05,12345,123456,0.001,1e-04,1.5e-07]]",
    ),
)
good(
    "float_large_whole",
    message(
        H % (120190, 40, 5, 1),
        "9007199254740992 1e+22 123456789012345680 1234567890123456774144 1.2345678901234568e+22",
        "[[9007199254740992,1e+22,123456789012345680,1234567890123456774144,1.2345678901234568e+22]]",
    ),
)
good(
    "float_shortest",
    message(
        H % (120191, 40, 3, 1),
        struct.pack("<3d", 0.1 + 0.2, 1 / 3, 100.5),
        "[[0.30000000000000004,0.3333333333333333,100.5]]",
    ),
)
good(
    "float_f32_shortest",
    message(
        H % (120181, 40, 3, 1),
        struct.pack("<3f", 0.1, 1 / 3, 16777216.0),
        "[[0.1,0.33333334,16777216]]",
    ),
)
good(
    "float_spellings_loose",
    message(
        H % (120190, 40, 9, 1),
        "0.10 1e2 1E+3 .5 2. 00.5 -0.0 NaN -Infinity",
        '[[0.1,100,1000,0.5,2,0.5,-0,"nan","-inf"]]',
    ),
)
good(
    "float_rounding_loose",
    message(
        H % (120190, 40, 3, 1),
        "9007199254740993 2.4703282292062328e-324 1e-999",
        "[[9007199254740992,5e-324,0]]",
    ),
)
# Halfway between two f32 but for a digit that an f64 does not hold: read once, it rounds up.
good(
    "float_f32_once_loose",
    message(
        H % (120180, 40, 2, 1),
        "1.00000005960464477540 7.006492321624086e-46",
        "[[1.0000001,1e-45]]",
    ),
)
good("float_long_loose", message(H % (120190, 40, 1, 1), "0." + "1" * 62, "[[0.1111111111111111]]"))
