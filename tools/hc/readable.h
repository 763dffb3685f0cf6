// SPDX-License-Identifier: Apache-2.0
#pragma once
// A message, and numbers, for a person's eyes.

#include <charconv>
#include <cmath>
#include <string>
#include <type_traits>

#include <hc/mtp/message.h>

namespace tool {

/// A line that says what the message is, and its elements below it: all of a small one, the corner
/// and the range of a large one.
std::string to_readable(const hc::Message& message);

/// "2025-11-21 04:20:00.123456789", in UTC.
std::string time_in_words(std::int64_t time);

/// Appends a number as MTP writes it in text, in the shortest form that reads back as the same
/// value: 0.1, 1e+05, -0, nan.
template <typename T>
void append_number(T value, std::string& text) {
  constexpr std::size_t kLongest = 32;
  if constexpr (std::is_floating_point_v<T>)
    if (std::isnan(value)) {
      text += "nan";
      return;
    }
  char number[kLongest];
  text.append(number, std::to_chars(number, number + kLongest, value).ptr);
}

}  // namespace tool
