// SPDX-License-Identifier: Apache-2.0
#pragma once
// The part of std::format that this project uses; g++ 12 has no <format>. Pure.

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

namespace hc {
namespace internal {

using FormatValue = std::variant<std::int64_t, std::uint64_t, double, std::string_view>;

template <typename T>
FormatValue format_value(const T& value) {
  static_assert(!std::is_same_v<T, char> && !std::is_same_v<T, bool>, "make it text or a number");
  if constexpr (std::is_floating_point_v<T>)
    return static_cast<double>(value);
  else if constexpr (std::is_integral_v<T> && std::is_signed_v<T>)
    return std::int64_t{value};
  else if constexpr (std::is_integral_v<T>)
    return std::uint64_t{value};
  else
    return std::string_view(value);
}

std::string format(std::string_view pattern, std::initializer_list<FormatValue> values);

}  // namespace internal

/// Formats values as std::format does.
///
///     format("{:<{}} {:>8} {:.2f}", name, width, count, 0.5)
///
/// A field is `{}` or `{:[<|>][0][width][.precision][f|g|x]}`; width and precision may be `{}` and
/// then take the next values. The width of a text is its number of UTF-8 code points. `{{` and `}}`
/// are braces. A pattern that does not match its values is a bug.
template <typename... Values>
std::string format(std::string_view pattern, const Values&... values) {
  return internal::format(pattern, {internal::format_value(values)...});
}

/// Joins words or integers with a separator.
template <typename Words>
std::string joined(const Words& words, std::string_view between) {
  std::string text;
  for (const auto& word : words) {
    if (!text.empty()) text += between;
    if constexpr (std::is_integral_v<std::remove_cvref_t<decltype(word)>>)
      text += std::to_string(word);
    else
      text += word;
  }
  return text;
}

/// Two lower-case hexadecimal digits per byte.
std::string hexadecimal(std::span<const unsigned char> bytes);

}  // namespace hc
