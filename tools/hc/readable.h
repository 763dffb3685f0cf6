// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages and numbers as text for people.

#include <charconv>
#include <cmath>
#include <string>
#include <type_traits>

#include <hc/mtp/message.h>

namespace tool {

/// A line about the header, then the elements: all of a small matrix, a corner and the range of a
/// large one.
std::string to_readable(const hc::Message& message);

/// "2025-11-21 04:20:00.123456789" (UTC)
std::string time_in_words(hc::Time time);

/// Appends a number as in MTP's text encoding, in the shortest form with the same value: 0.1,
/// 1e+05, -0, nan.
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
