// SPDX-License-Identifier: Apache-2.0
#pragma once
// Parsing and writing of small texts: separators, numbers, names of enumerators, hex digits. Pure.

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace hc {

/// The part of `text` before `mark`, or all of it without one; removes it and the mark from `text`.
inline std::string_view take_until(std::string_view& text, char mark) {
  const auto part = text.substr(0, text.find(mark));
  text.remove_prefix(std::min(text.size(), part.size() + 1));
  return part;
}

/// Parses a text that consists of one number; false, with `number` unchanged, if it does not or the
/// number is out of range.
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

/// The enumerator with a name.
/// @param names  of the enumerators 0, 1, 2, …
template <typename Enum, std::size_t kCount>
std::optional<Enum> enum_named(const std::array<std::string_view, kCount>& names,
                               std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Enum>(found - names.begin());
}

}  // namespace hc
