// SPDX-License-Identifier: Apache-2.0
#include <hc/base/result.h>

#include <array>

namespace hc {

std::string_view name(Code code) {
  constexpr std::array<std::string_view, 9> kNames = {// in the order of Code
                                                      "Malformed", "Unsupported", "TooLarge",
                                                      "Truncated", "Closed",      "Stopped",
                                                      "NotFound",  "Invalid",     "System"};
  return kNames.at(static_cast<std::size_t>(code));
}

std::string Error::text() const {
  return std::string(name(code)) + ": " + detail;
}

}  // namespace hc
