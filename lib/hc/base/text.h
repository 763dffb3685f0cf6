// SPDX-License-Identifier: Apache-2.0
#pragma once
// Texts taken apart: words between marks, and numbers; and the digits of bytes. Pure.

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <system_error>

namespace hc {

/// The part of `text` before `mark`, which is taken off it with the mark; all where there is none.
inline std::string_view take_until(std::string_view& text, char mark) {
  const auto part = text.substr(0, text.find(mark));
  text.remove_prefix(std::min(text.size(), part.size() + 1));
  return part;
}

/// Whether a text is a number, with nothing before or behind it, that fits; sets `number` then.
template <typename Number>
bool read_number(std::string_view text, Number& number) {
  const char* const end = text.data() + text.size();
  Number read{};
  const auto [stop, status] = std::from_chars(text.data(), end, read);
  if (stop != end || status != std::errc()) return false;
  number = read;
  return true;
}

/// The two lower-case hexadecimal digits of a byte.
inline std::string hexadecimal_byte(char byte) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  const auto value = static_cast<unsigned char>(byte);
  return {kDigits[value >> 4], kDigits[value & 15]};
}

}  // namespace hc
