// SPDX-License-Identifier: Apache-2.0
#pragma once
// The median of numbers. Pure. Header only.

#include <algorithm>
#include <cstddef>
#include <vector>

namespace hc {

/// The middle one of the sorted numbers; of an even count, the upper of the middle two.
/// @param numbers  at least one; none is NaN.
template <typename Number>
Number median(std::vector<Number> numbers) {
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  return *middle;
}

}  // namespace hc
