// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/mode_names.h>

#include <hc/base/text.h>

namespace hc {

std::string mode_names_text(const std::map<std::string, std::int64_t>& numbers) {
  std::string text;
  for (const auto& [name, number] : numbers)
    text += (text.empty() ? "" : ",") + name + "=" + std::to_string(number);
  return text;
}

Result<std::map<std::int32_t, std::string>> parse_mode_names(std::string_view text,
                                                             std::string_view parameter) {
  std::map<std::int32_t, std::string> names;
  for (bool is_more = !text.empty(); is_more;) {
    is_more = text.find(',') != std::string_view::npos;
    const auto word = take_until(text, ',');
    auto value = word;
    const auto name = take_until(value, '=');
    std::int32_t number = 0;
    if (name.empty() || !read_number(value, number) || number < 1 ||
        !names.emplace(number, name).second)
      return Error{Code::Invalid, std::string(parameter) + ": \"" + std::string(word) +
                                      "\" is not NAME=NUMBER with a unique number, as in "
                                      "read=5,track=4"};
  }
  return names;
}

}  // namespace hc
