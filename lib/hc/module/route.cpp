// SPDX-License-Identifier: Apache-2.0
#include <hc/module/route.h>

#include <algorithm>
#include <charconv>

namespace hc::internal {
namespace {

/// The part of `text` before `mark`, which is taken off it with the mark.
std::string_view take_until(std::string_view& text, char mark) {
  auto part = text.substr(0, text.find(mark));
  text.remove_prefix(std::min(text.size(), part.size() + 1));
  return part;
}

}  // namespace

bool Route::takes(std::int32_t dst) const {
  return takes_all || std::binary_search(to.begin(), to.end(), dst);
}

Result<Route> parse_route(std::string_view words) {
  Route route;
  while (!words.empty()) {
    auto value = take_until(words, ' ');
    auto key = take_until(value, '=');
    if (key == "peer" && !value.empty()) {
      route.peer = value;
    } else if (key == "to" && value == "*") {
      route.takes_all = true;
    } else if (key == "to") {
      route.takes_all = false;
      while (!value.empty()) {
        auto number = take_until(value, ',');
        std::int32_t dst = 0;
        const char* end = number.data() + number.size();
        auto [stop, status] = std::from_chars(number.data(), end, dst);
        if (stop != end || status != std::errc())
          return Error{Code::Invalid, "to= is * or addresses, not \"" + std::string(number) + "\""};
        route.to.push_back(dst);
      }
      std::sort(route.to.begin(), route.to.end());
    } else if (!key.empty()) {
      return Error{Code::Invalid,
                   "a route is to=ADDRESS,… and peer=NAME, not \"" + std::string(key) + "\""};
    }
  }
  return route;
}

}  // namespace hc::internal
