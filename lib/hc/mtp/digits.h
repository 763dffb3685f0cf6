// SPDX-License-Identifier: Apache-2.0
#pragma once
// Conversion of decimal digits, eight at a time in a 64-bit word. Internal. Pure.
// Source: the word tricks are in H. S. Warren, Hacker's Delight, 2nd ed., chapters 6 and 10.

#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

namespace hc::internal {

static_assert(std::endian::native == std::endian::little,
              "the binary form and the word tricks require a little-endian machine");

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

/// The value of eight digits, the first one in the lowest byte.
inline std::uint64_t value_of_digits(std::uint64_t word) {
  word -= kZeros;
  word = word * 10 + (word >> 8);  // pairs, in every second byte
  constexpr std::uint64_t kMask = 0x000000ff000000ff;
  return (((word & kMask) * 0x000f424000000064) + (((word >> 16) & kMask) * 0x0000271000000001)) >>
         32;
}

/// The eight digits of `value` < 10⁸, the first one in the lowest byte.
inline std::uint64_t digits_of_value(std::uint64_t value) {
  std::uint64_t high = value / 10000, low = value % 10000;
  std::uint64_t halves = high | (low << 32);
  std::uint64_t hundreds = ((halves * 10486) >> 20) & 0x0000007f0000007f;
  std::uint64_t pairs = hundreds | ((halves - 100 * hundreds) << 16);
  std::uint64_t tens = ((pairs * 103) >> 10) & 0x000f000f000f000f;
  return (tens | ((pairs - 10 * tens) << 8)) | kZeros;
}

/// The result of parsing a number: good, or the number of the rule that it breaks (R27, R28).
enum class Outcome { Good, NotANumber = 27, OutOfRange = 28 };

/// Parses an integer at the start of [first, last); `next` is the byte after it. A token that
/// breaks the spelling is NotANumber even if its value is out of range, too.
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

/// Writes an integer in decimal at `at`, which has room for 20 bytes; returns its end.
template <typename T>
char* write_integer(char* at, T value) {
  constexpr std::uint64_t kTenTo8 = 100'000'000;
  auto magnitude = static_cast<std::uint64_t>(+value);  // promoted, then widened
  if (magnitude < 10) {                                 // the most common case
    *at = static_cast<char>('0' + magnitude);
    return at + 1;
  }
  if (value < 0) {
    *at++ = '-';
    magnitude = 0 - magnitude;
  }
  if (magnitude < kTenTo8)
    return std::to_chars(at, at + 8, static_cast<std::uint32_t>(magnitude)).ptr;
  at = write_integer(at, magnitude / kTenTo8);
  const std::uint64_t digits = digits_of_value(magnitude % kTenTo8);
  std::memcpy(at, &digits, sizeof digits);
  return at + sizeof digits;
}

}  // namespace hc::internal
