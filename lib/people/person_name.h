// SPDX-License-Identifier: Apache-2.0
#pragma once
// Names of people, and the texts that give one to a track or a person. Pure, header only: the
// page's server needs no networks.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>

#include <hc/base/text.h>
#include <hc/base/visible.h>

namespace hc::people {

/// Whether a text can be the name of a person and of their file: 1 to 64 bytes of UTF-8, without
/// control characters, "/" and a dot at its beginning.
inline bool is_person_name(std::string_view text) {
  constexpr std::size_t kMost = 64;
  if (text.empty() || text.size() > kMost || text[0] == '.') return false;
  // Control characters, marks of writing direction and bytes that are not UTF-8 are not.
  if (visible(text) != text) return false;
  return std::ranges::none_of(text, [](char c) { return c == '\t' || c == '/'; });
}

/// A name, and the number of a track or of a person.
struct NumberedName {
  int number = 0;         ///< from 1
  std::string_view name;  ///< of the text; see is_person_name()
};
/// The parts of a text "NUMBER NAME"; nothing if it has no number.
inline std::optional<NumberedName> numbered_name(std::string_view text) {
  NumberedName named;
  if (!read_number(take_until(text, ' '), named.number) || named.number < 1) return std::nullopt;
  named.name = text;
  return named;
}

}  // namespace hc::people
