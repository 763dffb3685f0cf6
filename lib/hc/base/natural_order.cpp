// SPDX-License-Identifier: Apache-2.0
#include <hc/base/natural_order.h>

#include <algorithm>
#include <cstddef>
#include <tuple>

namespace hc {
namespace {

constexpr std::string_view kDigits = "0123456789";

/// Takes the leading number of `text`, which begins with a digit: its digits without leading zeros.
std::string_view take_number(std::string_view& text) {
  const auto end = std::min(text.find_first_not_of(kDigits), text.size());
  std::string_view number = text.substr(0, end);
  text.remove_prefix(end);
  number.remove_prefix(std::min(number.find_first_not_of('0'), number.size()));
  return number;
}

bool begins_with_number(std::string_view text) {
  return !text.empty() && kDigits.find(text.front()) != kDigits.npos;
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  std::string_view left = a, right = b;
  while (!left.empty() && !right.empty()) {
    if (begins_with_number(left) && begins_with_number(right)) {
      const auto x = take_number(left), y = take_number(right);
      // Of numbers without leading zeros the longer one is greater.
      if (x != y) return std::tuple(x.size(), x) < std::tuple(y.size(), y);
      continue;
    }
    if (left.front() != right.front())
      return static_cast<unsigned char>(left.front()) < static_cast<unsigned char>(right.front());
    left.remove_prefix(1);
    right.remove_prefix(1);
  }
  if (left.empty() != right.empty()) return left.empty();
  return a < b;
}

}  // namespace hc
