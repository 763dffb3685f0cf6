// SPDX-License-Identifier: Apache-2.0
#pragma once
// The time between things that are done at a rate. Pure. Internal.

#include <chrono>
#include <cmath>

#include <hc/base/clock.h>

namespace hc::internal {

/// As long as never, and short enough to be added to a time: 30 years.
constexpr MonotonicTime kLongestPeriod = std::chrono::seconds(1'000'000'000);

/// @param rate  [Hz]; of one that is 0, negative or no number the period is the longest.
inline MonotonicTime period_of(double rate) {
  const std::chrono::duration<double> period(1 / rate);
  if (!(rate > 0) || !std::isfinite(rate) || period >= kLongestPeriod) return kLongestPeriod;
  return std::chrono::duration_cast<MonotonicTime>(period);
}

}  // namespace hc::internal
