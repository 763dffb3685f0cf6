// SPDX-License-Identifier: Apache-2.0
#pragma once
// Periods of rates. Pure. Internal.

#include <chrono>
#include <cmath>

#include <hc/base/clock.h>

namespace hc::internal {

/// Means never, and can be added to a time without overflow: 30 years.
constexpr MonotonicTime kLongestPeriod = std::chrono::seconds(1'000'000'000);

/// The latest time of the messages' clock, to which periods can be added (2198). Messages may have
/// later times.
constexpr MonotonicTime kLatest = MonotonicTime::max() - 2 * kLongestPeriod;

/// @param rate  [Hz]; if it is 0, negative or NaN, the period is the longest.
inline MonotonicTime period_of(double rate) {
  const std::chrono::duration<double> period(1 / rate);
  if (!(rate > 0) || !std::isfinite(rate) || period >= kLongestPeriod) return kLongestPeriod;
  return std::chrono::duration_cast<MonotonicTime>(period);
}

}  // namespace hc::internal
