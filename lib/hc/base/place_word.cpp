// SPDX-License-Identifier: Apache-2.0
#include <hc/base/place_word.h>

#include <algorithm>
#include <filesystem>
#include <string>

namespace hc {

Result<Uri> parse_place_word(std::string_view word) {
  auto uri = parse_uri(word);
  const auto begin = parse_uri(word.substr(0, word.find('?')));
  if (word.empty() || word.starts_with("file:") || (begin && begin->scheme != "file")) return uri;
  std::error_code missing;
  const bool is_name = uri && (uri->options.empty() || !std::filesystem::exists(word, missing));
  if (is_name) return uri;
  return Uri{"file", std::string(word), {}};
}

bool is_mcap_path(std::string_view path) {
  constexpr std::string_view kEnding = ".mcap";
  return path.size() >= kEnding.size() &&
         std::ranges::equal(path.substr(path.size() - kEnding.size()), kEnding, [](char a, char b) {
           return (a >= 'A' && a <= 'Z' ? a + 32 : a) == b;
         });
}

}  // namespace hc
