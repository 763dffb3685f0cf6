// SPDX-License-Identifier: Apache-2.0
#include <hc/base/visible.h>

#include <algorithm>
#include <array>

#include <hc/base/json_string.h>
#include <hc/base/text.h>

namespace hc {
namespace {

/// Whether a UTF-8 character controls a terminal. Source: The Unicode Standard, 23.1 and 23.2.
bool is_control(std::string_view character) {
  const char first = character.front();
  if (character.size() == 1)
    return (static_cast<unsigned char>(first) < 0x20 && first != '\t') || first == 0x7f;
  constexpr std::string_view kC1End = "\xc2\xa0";
  if (character.size() == 2) return character < kC1End;
  if (character.size() != 3) return false;
  auto bits = [&](std::size_t i, unsigned mask) {
    return static_cast<unsigned char>(character[i]) & mask;
  };
  const unsigned point = bits(0, 0x0f) << 12 | bits(1, 0x3f) << 6 | bits(2, 0x3f);
  // Line separators and marks of writing direction.
  constexpr std::array<std::array<unsigned, 2>, 3> kRanges = {
      {{0x200e, 0x200f}, {0x2028, 0x202e}, {0x2066, 0x2069}}};
  return std::ranges::any_of(
      kRanges, [&](const auto& range) { return range[0] <= point && point <= range[1]; });
}

}  // namespace

std::string visible(std::string_view line) {
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
    for (const char c : character) text.append("\\x").append(hexadecimal_byte(c));
  }
  return text;
}

}  // namespace hc
