// SPDX-License-Identifier: Apache-2.0
#pragma once
// Splits a text into words. Pure.

#include <algorithm>
#include <string_view>
#include <vector>

namespace hc {

/// The non-empty parts of `text` between separators.
inline std::vector<std::string_view> words_of(std::string_view text,
                                              std::string_view marks = " \t\n") {
  std::vector<std::string_view> words;
  for (std::size_t at = text.find_first_not_of(marks); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(marks, at), text.size());
    words.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(marks, end);
  }
  return words;
}

}  // namespace hc
