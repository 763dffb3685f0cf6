// SPDX-License-Identifier: Apache-2.0
#include <hc/base/json_string.h>

#include <hc/base/text.h>

namespace hc {

// Source: The Unicode Standard, table 3-7.
std::size_t utf8_length(std::string_view text) {
  auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  auto is_tail = [&](std::size_t i) { return (byte(i) & 0xc0) == 0x80; };
  unsigned first = byte(0), second = byte(1);
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first <= 0xdf) return is_tail(1) ? 2 : 0;
  if (first >= 0xe0 && first <= 0xef) {
    bool wrong = (first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f);
    return !wrong && is_tail(1) && is_tail(2) ? 3 : 0;
  }
  if (first >= 0xf0 && first <= 0xf4) {
    bool wrong = (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f);
    return !wrong && is_tail(1) && is_tail(2) && is_tail(3) ? 4 : 0;
  }
  return 0;
}

void append_json_string(std::string_view text, std::string& json) {
  constexpr std::string_view kEscaped = "\"\\\n\r\t", kLetters = "\"\\nrt";
  json += '"';
  while (!text.empty()) {
    std::size_t length = utf8_length(text);
    char c = text.front();
    if (length == 0) {
      json += "\xef\xbf\xbd";  // U+FFFD
      length = 1;
    } else if (const auto at = kEscaped.find(c); at != std::string_view::npos) {
      json.append("\\").append(1, kLetters[at]);
    } else if (static_cast<unsigned char>(c) < 0x20) {
      json.append("\\u00").append(hexadecimal_byte(c));
    } else {
      json += text.substr(0, length);
    }
    text.remove_prefix(length);
  }
  json += '"';
}

}  // namespace hc
