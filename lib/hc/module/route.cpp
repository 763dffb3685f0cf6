// SPDX-License-Identifier: Apache-2.0
#include <hc/module/route.h>

#include <algorithm>

#include <hc/base/text.h>

namespace hc::internal {

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
        if (!read_number(number, route.to.emplace_back()))
          return Error{Code::Invalid, "to= is * or addresses, not \"" + std::string(number) + "\""};
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
