// SPDX-License-Identifier: Apache-2.0
#include <hc/base/visible.h>

#include <algorithm>
#include <array>

#include <hc/base/json_string.h>

namespace hc {
namespace {

/// Whether a character of UTF-8 steers a terminal. Source: The Unicode Standard, 23.1 and 23.2.
bool is_control(std::string_view character) {
  const char first = character.front();
  if (character.size() == 1)
    return (static_cast<unsigned char>(first) < 0x20 && first != '\t') || first == 0x7f;
  constexpr std::string_view kC1End = "\xc2\xa0";
  if (character.size() == 2) return character < kC1End;
  constexpr std::array<std::array<std::string_view, 2>, 3> kDirections = {{
      {"\xe2\x80\x8e", "\xe2\x80\x8f"},  // U+200E, U+200F
      {"\xe2\x80\xa8", "\xe2\x80\xae"},  // U+2028 … U+202E, line ends too
      {"\xe2\x81\xa6", "\xe2\x81\xa9"},  // U+2066 … U+2069
  }};
  return std::ranges::any_of(kDirections, [&](const auto& range) {
    return range[0] <= character && character <= range[1];
  });
}

}  // namespace

std::string visible(std::string_view line) {
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string text;
  text.reserve(line.size());
  while (!line.empty()) {
    const std::size_t length = utf8_length(line);
    const auto character = line.substr(0, std::max<std::size_t>(length, 1));
    line.remove_prefix(character.size());
    if (length > 0 && !is_control(character)) {
      text += character;
      continue;
    }
    for (const char c : character) {
      const auto byte = static_cast<unsigned char>(c);
      text.append("\\x").append({kHex[byte >> 4], kHex[byte & 15]});
    }
  }
  return text;
}

}  // namespace hc
