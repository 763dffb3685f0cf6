// SPDX-License-Identifier: Apache-2.0
#pragma once
// Decimal digits, eight at a time in one machine word. Internal. Pure.
// Source: the word tricks are in H. S. Warren, Hacker's Delight, 2nd ed., chapters 6 and 10.

#include <bit>
#include <cstdint>
#include <cstring>

namespace hc::internal {

static_assert(std::endian::native == std::endian::little,
              "the binary form and the word tricks want a little-endian machine");

inline std::uint64_t load8(const char* at) {
  std::uint64_t word;
  std::memcpy(&word, at, sizeof word);
  return word;
}

/// Marks (0x80) the bytes of `word` that are not '0' … '9'.
inline std::uint64_t non_digits(std::uint64_t word) {
  constexpr std::uint64_t kZeros = 0x3030303030303030, kHigh = 0x8080808080808080;
  std::uint64_t value = word ^ kZeros;  // a digit becomes 0 … 9
  return (((value & ~kHigh) + 0x7676767676767676) | value) & kHigh;
}

/// The value of eight digits, the first in the lowest byte.
inline std::uint64_t value_of_digits(std::uint64_t word) {
  word -= 0x3030303030303030;
  word = word * 10 + (word >> 8);  // pairs, in every second byte
  constexpr std::uint64_t kMask = 0x000000ff000000ff;
  return (((word & kMask) * 0x000f424000000064) + (((word >> 16) & kMask) * 0x0000271000000001)) >>
         32;
}

/// Eight digits of `value` < 10⁸, the first in the lowest byte.
inline std::uint64_t digits_of_value(std::uint64_t value) {
  std::uint64_t high = value / 10000, low = value % 10000;
  std::uint64_t halves = high | (low << 32);
  std::uint64_t hundreds = ((halves * 10486) >> 20) & 0x0000007f0000007f;
  std::uint64_t pairs = hundreds | ((halves - 100 * hundreds) << 16);
  std::uint64_t tens = ((pairs * 103) >> 10) & 0x000f000f000f000f;
  return (tens | ((pairs - 10 * tens) << 8)) | 0x3030303030303030;
}

/// Writes `value` in decimal at `at`, which has room for 20 bytes and 8 more; returns the end.
inline char* write_digits(char* at, std::uint64_t value) {
  constexpr std::uint64_t kTenTo8 = 100'000'000;
  auto first = [&](std::uint64_t part) {  // < 10⁸, without leading zeros
    std::uint64_t digits = digits_of_value(part);
    int zeros = part == 0 ? 7 : std::countr_zero(digits & 0x0f0f0f0f0f0f0f0f) / 8;
    digits >>= zeros * 8;
    std::memcpy(at, &digits, sizeof digits);
    at += 8 - zeros;
  };
  auto next = [&](std::uint64_t part) {
    std::uint64_t digits = digits_of_value(part);
    std::memcpy(at, &digits, sizeof digits);
    at += 8;
  };
  if (value < 10) {
    *at = static_cast<char>('0' + value);
    return at + 1;
  }
  if (value < 100) {
    at[0] = static_cast<char>('0' + value / 10);
    at[1] = static_cast<char>('0' + value % 10);
    return at + 2;
  }
  if (value < kTenTo8) {
    first(value);
  } else if (value < kTenTo8 * kTenTo8) {
    first(value / kTenTo8);
    next(value % kTenTo8);
  } else {
    std::uint64_t rest = value % (kTenTo8 * kTenTo8);
    first(value / (kTenTo8 * kTenTo8));
    next(rest / kTenTo8);
    next(rest % kTenTo8);
  }
  return at;
}

/// Writes a negative or positive value; room as write_digits, and one byte for the sign.
inline char* write_integer(char* at, std::int64_t value) {
  auto magnitude = static_cast<std::uint64_t>(value);
  if (value < 0) {
    *at++ = '-';
    magnitude = 0 - magnitude;
  }
  return write_digits(at, magnitude);
}

}  // namespace hc::internal
