# SPDX-License-Identifier: Apache-2.0
"""The numbers of MTP/1: from text to the bits of a scalar and back (R5, R27, R28, R39)."""

import functools
import math
import re
import struct
from decimal import Decimal
from fractions import Fraction

# Name of a scalar, and its code in the struct module; the index is the digit S of info.
SCALARS = ("u8", "i8", "u16", "i16", "u32", "i32", "u64", "i64", "f32", "f64")
CODES = tuple(struct.Struct("<" + code) for code in "BbHhIiQqfd")
FLOATS = ("f32", "f64")

INTEGER = re.compile(rb"0|-?[1-9][0-9]*")
FLOAT = re.compile(
    rb"-?(?:(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|(?i:nan|inf|infinity))"
)


def nearest(text, scalar):
    """The value of an f32 or f64 nearest to a decimal number, ties to even, rounded once. R27.

    Raises OverflowError when a finite number rounds to infinity (R28).
    """
    value = float(text)  # Python rounds correctly to binary64
    if "n" in text.lower():  # nan, inf, infinity: the digits and e have no n
        return value
    if scalar == "f32":
        return nearest_f32(text, value)
    if math.isinf(value):
        raise OverflowError(text)
    return value


def nearest_f32(text, value):
    """The f32 nearest to `text`, given the f64 nearest to it.

    Rounding twice goes wrong only where the first step lands in the very middle of two f32: there
    the f64 is moved one step towards the exact number, so that the second step goes the right way.
    """
    fraction, exponent = math.frexp(value)
    bits = min(24, exponent + 149)  # of an f32 as large as this: fewer when it is subnormal
    if bits >= 0 and math.isfinite(value) and math.ldexp(fraction, bits + 1) % 2 == 1:
        exact = Fraction(text)
        if exact != Fraction(value):
            value = math.nextafter(value, math.inf if exact > Fraction(value) else -math.inf)
    if math.isinf(value):
        raise OverflowError(text)
    return struct.unpack("<f", struct.pack("<f", value))[0]  # OverflowError above the greatest f32


def spell(number, scalar):
    """The canonical spelling of a number. R38, R39."""
    if scalar not in FLOATS:
        return str(number)
    if not math.isfinite(number):
        return "nan" if math.isnan(number) else "inf" if number > 0 else "-inf"
    sign = "-" if math.copysign(1, number) < 0 else ""
    return sign + spell_magnitude(abs(number), scalar)


def spell_magnitude(value, scalar):
    """The canonical spelling of a finite float that is not negative. R39."""
    if value == 0:
        return "0"
    digits, exponent = shortest(value, scalar)  # d.ddd times ten to the exponent
    point = exponent + 1  # digits before the point
    if point <= 0:
        fixed = "0." + "0" * -point + digits
    elif point < len(digits):
        fixed = digits[:point] + "." + digits[point:]
    else:
        fixed = str(int(value))
    scientific = digits[0] + ("." + digits[1:] if digits[1:] else "") + f"e{exponent:+03d}"
    return fixed if len(fixed) <= len(scientific) else scientific


def shortest(value, scalar):
    """The fewest digits that read back to a positive float, and the exponent of the first. R39."""
    # repr() gives the fewest digits of an f64, and of several the nearest.
    number = Decimal(repr(value) if scalar == "f64" else shortest_f32(value))
    return "".join(map(str, number.as_tuple().digits)).rstrip("0"), number.adjusted()


@functools.lru_cache(maxsize=1 << 16)
def shortest_f32(value):
    """A spelling of a positive f32 with the fewest digits; of several the nearest, then the even.

    Only the two decimals next to the value can be the nearest with so many digits. Both are tried:
    below a power of two floats stand closer together, so the nearer one may be another float's.
    """
    exact = Fraction(value)
    for count in range(1, 10):  # nine digits tell any two f32 apart
        last = Decimal(value).adjusted() - count + 1
        unit = Fraction(10) ** last
        below = exact // unit
        hits = [n for n in (below, below + 1) if n and reads_back(f"{n}e{last}", value)]
        if hits:
            best = min(hits, key=lambda n: (abs(n * unit - exact), n % 2))
            return f"{best}e{last}"
    raise AssertionError(f"{value!r} is no f32")


def reads_back(text, value):
    """Whether a text is read as just this f32."""
    try:
        return nearest(text, "f32") == value
    except OverflowError:
        return False
