// SPDX-License-Identifier: Apache-2.0
#pragma once
// Decimal digits, eight at a time in one machine word. Internal. Pure.
// Source: the word tricks are in H. S. Warren, Hacker's Delight, 2nd ed., chapters 6 and 10.

#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

namespace hc::internal {

static_assert(std::endian::native == std::endian::little,
              "the binary form and the word tricks want a little-endian machine");

inline std::uint64_t load8(const char* at) {
  std::uint64_t word;
  std::memcpy(&word, at, sizeof word);
  return word;
}

inline constexpr std::uint64_t kZeros = 0x3030303030303030;  ///< eight times '0'

/// Marks (0x80) the bytes of `word` that are not '0' … '9'.
inline std::uint64_t non_digits(std::uint64_t word) {
  constexpr std::uint64_t kHigh = 0x8080808080808080;
  std::uint64_t value = word ^ kZeros;  // a digit becomes 0 … 9
  return (((value & ~kHigh) + 0x7676767676767676) | value) & kHigh;
}

/// The value of eight digits, the first in the lowest byte.
inline std::uint64_t value_of_digits(std::uint64_t word) {
  word -= kZeros;
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
  return (tens | ((pairs - 10 * tens) << 8)) | kZeros;
}

/// "00" to "99".
inline constexpr std::array<char, 200> kPairs = [] {
  std::array<char, 200> pairs{};
  for (unsigned i = 0; i < 200; ++i)
    pairs[i] = static_cast<char>('0' + (i % 2 == 0 ? i / 20 : i / 2 % 10));
  return pairs;
}();

/// How reading a number went; the rule's number when it did not (R27, R28).
enum class Outcome { Good, NotANumber = 27, OutOfRange = 28 };

/// Reads a number at the start of [first, last); `next` is the byte behind it. With NotANumber the
/// whole token is at fault, wherever the spelling broke.
template <typename T>
Outcome read_integer(const char* first, const char* last, T& value, const char*& next) {
  const char* at = first;
  bool negative = at != last && *at == '-';
  if (negative) ++at;
  const char* digits = at;
  std::uint64_t magnitude = 0;
  while (at != last) {
    auto digit = static_cast<unsigned char>(*at - '0');
    if (digit > 9) break;
    magnitude = magnitude * 10 + digit;
    ++at;
  }
  next = at;
  auto length = at - digits;
  if (length == 0 || (*digits == '0' && (length > 1 || negative))) return Outcome::NotANumber;
  if (length < 20 && magnitude < std::uint64_t{1} << 63) [[likely]] {
    auto exact = static_cast<std::int64_t>(magnitude);
    if (negative) exact = -exact;
    if (exact < 0 ? static_cast<std::int64_t>(std::numeric_limits<T>::min()) > exact
                  : static_cast<std::uint64_t>(std::numeric_limits<T>::max()) <
                        static_cast<std::uint64_t>(exact))
      return Outcome::OutOfRange;
    value = static_cast<T>(exact);
    return Outcome::Good;
  }
  if (negative && std::is_unsigned_v<T>) return Outcome::OutOfRange;
  auto status = std::from_chars(first, at, value).ec;
  return status == std::errc() ? Outcome::Good : Outcome::OutOfRange;
}

// The writers below give back where they ended. Those of few digits go by branches, which are
// mostly predicted right, so that what comes next need not wait for the value.

/// Writes both digits of `value` < 100.
inline char* write_2_digits(char* at, std::uint64_t value) {
  std::memcpy(at, &kPairs[2 * value], 2);
  return at + 2;
}

/// Writes `value` < 10000 without leading zeros.
inline char* write_up_to_4_digits(char* at, std::uint64_t value) {
  if (value >= 100) return write_2_digits(write_up_to_4_digits(at, value / 100), value % 100);
  if (value >= 10) return write_2_digits(at, value);
  *at = static_cast<char>('0' + value);
  return at + 1;
}

/// Writes all eight digits of `value` < 10⁸.
inline char* write_8_digits(char* at, std::uint64_t value) {
  std::uint64_t digits = digits_of_value(value);
  std::memcpy(at, &digits, sizeof digits);
  return at + 8;
}

/// Writes `value` in decimal at `at`, which has room for 20 bytes.
inline char* write_digits(char* at, std::uint64_t value) {
  constexpr std::uint64_t kTenTo4 = 10'000, kTenTo8 = kTenTo4 * kTenTo4;
  if (value < kTenTo4) return write_up_to_4_digits(at, value);
  if (value >= kTenTo8) return write_8_digits(write_digits(at, value / kTenTo8), value % kTenTo8);
  at = write_up_to_4_digits(at, value / kTenTo4);
  return write_2_digits(write_2_digits(at, value / 100 % 100), value % 100);
}

/// Writes a negative or positive value; room as write_digits, and one byte for the sign.
inline char* write_integer(char* at, std::int64_t value) {
  auto magnitude = static_cast<std::uint64_t>(value);
  if (magnitude < 10) {  // the commonest, here so that it is inlined
    *at = static_cast<char>('0' + magnitude);
    return at + 1;
  }
  if (value < 0) {
    *at++ = '-';
    magnitude = 0 - magnitude;
  }
  return write_digits(at, magnitude);
}

}  // namespace hc::internal
