// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/stops.h>

#include <algorithm>

#include <hc/base/text.h>

namespace hc {

bool any_stops(const Stops& stops) {
  return std::any_of(stops.begin(), stops.end(), [](const auto& each) { return each.second; });
}

std::string source_name(std::int32_t source, const std::map<std::int32_t, std::string>& names) {
  const auto found = names.find(source);
  if (found != names.end()) return found->second;
  return source == 0 ? "a program outside the graph" : "source " + std::to_string(source);
}

std::vector<std::string> names_of_stops(const Stops& stops,
                                        const std::map<std::int32_t, std::string>& names) {
  std::vector<std::string> found;
  for (const auto& [source, is_stop] : stops)
    if (is_stop) found.push_back(source_name(source, names));
  return found;
}

std::string stops_text(const Stops& stops) {
  std::string text;
  for (const auto& [source, is_stop] : stops)
    text += (text.empty() ? "" : ",") + std::to_string(source) + (is_stop ? "=1" : "=0");
  return text;
}

Result<Stops> parse_stops(std::string_view text) {
  Stops stops;
  for (bool is_more = !text.empty(); is_more;) {
    is_more = text.find(',') != std::string_view::npos;
    const auto word = take_until(text, ',');
    auto value = word;
    std::int32_t source = 0;
    if (!read_number(take_until(value, '='), source) || (value != "0" && value != "1"))
      return Error{Code::Invalid, std::string(kStops) + ": \"" + std::string(word) +
                                      "\" is not SRC=0 or SRC=1, as in 12=1,14=0"};
    stops[source] = value == "1";
  }
  return stops;
}

}  // namespace hc
