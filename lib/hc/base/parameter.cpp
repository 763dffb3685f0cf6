// SPDX-License-Identifier: Apache-2.0
#include <hc/base/parameter.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <hc/base/text.h>

namespace hc {
namespace {

std::string number_text(double value) {
  constexpr double kExact = 1e15;
  if (std::abs(value) < kExact && std::trunc(value) == value)
    return std::to_string(static_cast<std::int64_t>(value));
  std::array<char, 32> written;
  return {written.data(),
          std::to_chars(written.data(), written.data() + written.size(), value).ptr};
}

}  // namespace

std::string range_in_words(const ParameterOptions& options) {
  const bool has_least = std::isfinite(options.min), has_most = std::isfinite(options.max);
  if (has_least && options.step > 1)
    return number_text(options.min) + ", " +
           number_text(options.min + static_cast<double>(options.step)) + ", …" +
           (has_most ? ", " + number_text(options.max) : "");
  if (has_least && has_most)
    return "from " + number_text(options.min) + " to " + number_text(options.max);
  if (has_least) return "at least " + number_text(options.min);
  return has_most ? "at most " + number_text(options.max) : "";
}

std::string_view type_name(const ParameterValue& value) {
  constexpr std::array<std::string_view, 4> kNames = {"bool", "integer", "number", "string"};
  return kNames[value.index()];
}

std::string text(const ParameterValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const auto* number = std::get_if<double>(&value)) return number_text(*number);
  return std::get<std::string>(value);
}

Status ParameterState::set(std::string_view given) {
  auto refuse = [&](const std::string& wanted) {
    return Error{Code::Invalid,
                 "parameter " + name + ": \"" + std::string(given) + "\" is not " + wanted};
  };
  double number = 0;
  if (auto* flag = std::get_if<bool>(&value)) {
    if (given != "true" && given != "false") return refuse("true or false");
    *flag = given == "true";
    is_set = true;
    return {};
  }
  if (auto* string = std::get_if<std::string>(&value)) {
    const auto& choices = options.choices;
    if (!choices.empty() && std::find(choices.begin(), choices.end(), given) == choices.end()) {
      std::string wanted;
      for (const auto& choice : choices)
        wanted.append(wanted.empty() ? "one of " : ", ").append(choice);
      return refuse(wanted);
    }
    *string = given;
    is_set = true;
    return {};
  }
  std::int64_t integer = 0;
  bool whole = std::holds_alternative<std::int64_t>(value);
  if (whole ? !read_number(given, integer) : !read_number(given, number))
    return refuse(whole ? "a whole number" : "a number");
  if (whole) number = static_cast<double>(integer);
  const bool is_within = number >= options.min && number <= options.max;
  const bool is_step = !whole || options.step == 1 || !std::isfinite(options.min) ||
                       (integer - static_cast<std::int64_t>(options.min)) % options.step == 0;
  if (!is_within || !is_step || std::isnan(number)) {
    const std::string range = range_in_words(options);
    return refuse(range.empty() ? "a number" : range);
  }
  if (whole)
    value = integer;
  else
    value = number;
  is_set = true;
  return {};
}

}  // namespace hc
