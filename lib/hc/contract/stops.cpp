// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/stops.h>

#include <algorithm>
#include <charconv>

namespace hc {

bool any_stops(const Stops& stops) {
  return std::any_of(stops.begin(), stops.end(), [](const auto& each) { return each.second; });
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
    const auto word = text.substr(0, text.find(','));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    std::int32_t source = 0;
    const auto [after, error] = std::from_chars(word.data(), word.data() + word.size(), source);
    const std::string_view rest(after, static_cast<std::size_t>(word.data() + word.size() - after));
    if (error != std::errc() || (rest != "=0" && rest != "=1"))
      return Error{Code::Invalid, std::string(kStops) + ": \"" + std::string(word) +
                                      "\" is not SRC=0 or SRC=1, as in 12=1,14=0"};
    stops[source] = rest == "=1";
  }
  return stops;
}

}  // namespace hc
