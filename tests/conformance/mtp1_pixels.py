# SPDX-License-Identifier: Apache-2.0
"""From the coefficients of a JPEG image to its samples: inverse DCT, upsampling, colours.

ITU-T T.81 leaves the last bit open. Here the sums are those of the IJG's slow integer DCT and
triangle filter, so that results agree with most decoders to a unit.
"""

# Place in a block (row by row) of each coefficient of the stream; figure A.6
ZIGZAG = sorted(
    range(64),
    key=lambda at: (at // 8 + at % 8, (at // 8 if (at // 8 + at % 8) % 2 else at % 8)),
)


def plane(part):
    """The rows of a component's samples."""
    rows = []
    for row in range(part.rows):
        lines = [bytearray() for _ in range(8)]
        for column in range(part.columns):
            at = 64 * (row * part.stride + column)
            block = inverse_dct(part.coefficients[at : at + 64], part.table)
            for line, samples in zip(lines, block):
                line += samples
        rows += [bytes(line[: part.width]) for line in lines]
    return rows[: part.height]


def inverse_dct(coefficients, table):
    """The eight rows of samples of a block, in integers with two bits to spare. A.3.3, A.3.4"""
    if not any(coefficients[1:]):
        return [bytes([clamp((coefficients[0] * table[0] + 4 >> 3) + 128)]) * 8] * 8
    values = [0] * 64
    for index, place in enumerate(ZIGZAG):
        values[place] = coefficients[place] * table[index]
    columns = [transform(values[x::8], 11) for x in range(8)]
    rows = [transform([column[y] for column in columns], 18) for y in range(8)]
    return [bytes([clamp(value + 128) for value in row]) for row in rows]


def transform(v, shift):
    """Eight values through a one-dimensional inverse DCT, rounded and shifted down.

    Source: C. Loeffler, A. Ligtenberg, G. Moschytz, Practical fast 1-D DCT algorithms with 11
    multiplications, ICASSP 1989; constants times 2^13.
    """
    z = (v[2] + v[6]) * 4433
    even2, even3 = z - v[6] * 15137, z + v[2] * 6270
    even0, even1 = v[0] + v[4] << 13, v[0] - v[4] << 13
    half = 1 << shift - 1
    sums = (even0 + even3 + half, even1 + even2 + half, even1 - even2 + half, even0 - even3 + half)
    z1, z2, z3, z4 = v[7] + v[1], v[5] + v[3], v[7] + v[3], v[5] + v[1]
    z5 = (z3 + z4) * 9633
    z1, z2, z3, z4 = z1 * -7373, z2 * -20995, z5 - z3 * 16069, z5 - z4 * 3196
    odds = (
        v[1] * 12299 + z1 + z4,
        v[3] * 25172 + z2 + z3,
        v[5] * 16819 + z2 + z4,
        v[7] * 2446 + z1 + z3,
    )
    first = [even + odd >> shift for even, odd in zip(sums, odds)]
    return first + [even - odd >> shift for even, odd in zip(sums[::-1], odds[::-1])]


def clamp(value):
    """The nearest value of 8 bits."""
    return 0 if value < 0 else 255 if value > 255 else value


def upsample(rows, part, frame):
    """The rows of a component at the image's size.

    Twice as many: between two samples, three parts of the nearer and one of the farther (rounded
    down and up in turns). Any other ratio: the sample that lies there.
    """
    is_wide = frame.h == 2 * part.h and part.width > 2
    is_high = frame.v == 2 * part.v and (is_wide or frame.h == part.h)
    is_even = frame.v == part.v
    if is_high:
        pairs = [(rows[y], rows[max(y - 1, 0)]) for y in range(len(rows))]
        below = [(rows[y], rows[min(y + 1, len(rows) - 1)]) for y in range(len(rows))]
        both = [pair for two in zip(pairs, below) for pair in two][: frame.height]
        sums = [[3 * a + b for a, b in zip(near, far)] for near, far in both]
        if is_wide:
            return [widened(line, 4, 8, 7)[: frame.width] for line in sums]
        return [bytes(s + 1 + y % 2 >> 2 for s in line) for y, line in enumerate(sums)]
    if is_wide and is_even:
        return [widened(line, 2, 1, 2)[: frame.width] for line in rows]
    columns = [x * part.h // frame.h for x in range(frame.width)]
    return [bytes(rows[y * part.v // frame.v][x] for x in columns) for y in range(frame.height)]


def widened(line, shift, down, up):
    """A line twice as wide, its ends as they are."""
    last = len(line) - 1
    out = bytearray()
    for x, value in enumerate(line):
        left, right = line[x - 1] if x else value, line[x + 1] if x < last else value
        out.append(3 * value + left + down >> shift)
        out.append(3 * value + right + up >> shift)
    return bytes(out)


def to_rgb(luma, blue, red):
    """The three lines of a line of YCbCr. Source: JFIF 1.02, in integers times 2^16."""
    r, g, b = bytearray(), bytearray(), bytearray()
    for y, cb, cr in zip(luma, blue, red):
        cb, cr = cb - 128, cr - 128
        r.append(clamp(y + (91881 * cr + 32768 >> 16)))
        g.append(clamp(y + (-22554 * cb - 46802 * cr + 32768 >> 16)))
        b.append(clamp(y + (116130 * cb + 32768 >> 16)))
    return r, g, b


def interleave(lines):
    """Samples of three lines next to one another."""
    return bytes(sample for pixel in zip(*lines) for sample in pixel)
