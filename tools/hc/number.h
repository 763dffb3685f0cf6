// SPDX-License-Identifier: Apache-2.0
#pragma once
// Numbers as MTP writes them in text: in the shortest form that reads back as the same value.

#include <charconv>
#include <cmath>
#include <string>
#include <type_traits>

namespace tool {

/// Appends one number: 0.1, 1e+05, -0, nan.
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
