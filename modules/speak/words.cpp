// SPDX-License-Identifier: Apache-2.0
#include "words.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <hc/base/json_string.h>

namespace {

constexpr std::size_t kLongestWord = 60;

/// The first character of a text, and its length in bytes; nothing if it is not UTF-8.
std::optional<std::pair<char32_t, std::size_t>> first_of(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::size_t size = hc::utf8_length(text);
  if (size == 0) return std::nullopt;
  char32_t character = size == 1 ? byte(0) : byte(0) & (0x7FU >> size);
  for (std::size_t i = 1; i < size; ++i) character = character << 6 | (byte(i) & 0x3FU);
  return std::pair{character, size};
}

bool is_harmless(char32_t character) {
  const bool is_control = character < 0x20 || (character >= 0x7F && character < 0xA0);
  const bool is_private = (character >= 0xE000 && character < 0xF900) || character >= 0xF0000;
  const bool is_no_character = (character & 0xFFFE) == 0xFFFE ||
                               (character >= 0xFDD0 && character < 0xFDF0) ||
                               (character >= 0x2028 && character < 0x2030);  // line ends, direction
  return !is_control && !is_private && !is_no_character;
}

}  // namespace

std::u32string speakable(std::string_view text, std::size_t most) {
  std::u32string characters;
  std::size_t in_word = 0;
  while (!text.empty() && characters.size() < most) {
    const auto first = first_of(text);
    text.remove_prefix(first ? first->second : 1);
    char32_t character = first && is_harmless(first->first) ? first->first : U' ';
    if (character == U' ' && !characters.empty() && characters.back() == U' ') continue;
    in_word = character == U' ' ? 0 : in_word + 1;
    if (in_word > kLongestWord) {
      characters += U' ';
      in_word = 1;
    }
    characters += character;
  }
  return characters;
}

std::string utf8(std::u32string_view characters) {
  std::string text;
  for (const char32_t c : characters) {
    const auto tail = [&](int shift) { text += static_cast<char>(0x80 | (c >> shift & 0x3F)); };
    if (c < 0x80) {
      text += static_cast<char>(c);
    } else if (c < 0x800) {
      text += static_cast<char>(0xC0 | c >> 6);
      tail(0);
    } else if (c < 0x10000) {
      text += static_cast<char>(0xE0 | c >> 12);
      tail(6);
      tail(0);
    } else {
      text += static_cast<char>(0xF0 | c >> 18);
      tail(12);
      tail(6);
      tail(0);
    }
  }
  return text;
}

bool is_blank(std::u32string_view characters) {
  return characters.find_first_not_of(U' ') == std::u32string_view::npos;
}

bool TextQueue::push(WaitingText text, std::size_t most) {
  texts_.push_back(std::move(text));
  if (texts_.size() <= most) return false;
  texts_.pop_front();
  return true;
}

WaitingText TextQueue::pop() {
  auto text = std::move(texts_.front());
  texts_.pop_front();
  return text;
}
