// SPDX-License-Identifier: Apache-2.0
#pragma once
// Names of people, and by which a person asks to learn one. Pure, header only: the page's server
// needs no networks.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>

#include <hc/base/json_string.h>
#include <hc/base/text.h>

namespace hc::people {

/// Whether a text can be the name of a person and of their file: 1 to 64 bytes of UTF-8, without
/// control characters, "/" and a dot at its beginning.
inline bool is_person_name(std::string_view text) {
  constexpr std::size_t kMost = 64;
  if (text.empty() || text.size() > kMost || text[0] == '.') return false;
  if (std::ranges::any_of(text, [](unsigned char c) { return c < 0x20 || c == 0x7f || c == '/'; }))
    return false;
  while (!text.empty()) {
    const auto length = utf8_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

/// A name for the person of a track.
struct NamedTrack {
  int track = 0;          ///< from 1
  std::string_view name;  ///< of the text; see is_person_name()
};
/// The parts of a text "TRACK NAME"; nothing if it has no track.
inline std::optional<NamedTrack> named_track(std::string_view text) {
  NamedTrack named;
  if (!read_number(take_until(text, ' '), named.track) || named.track < 1) return std::nullopt;
  named.name = text;
  return named;
}

}  // namespace hc::people
