// SPDX-License-Identifier: Apache-2.0
#pragma once
// The types of times, and their conversions. Pure.

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace hc {

/// Time since a fixed moment; never goes back, even if the wall clock is set.
using MonotonicTime = std::chrono::nanoseconds;

/// A moment of the wall clock [ns since the Unix epoch, UTC]; Time{}: unknown.
using Time = std::chrono::sys_time<std::chrono::nanoseconds>;

/// The time in the form that messages, files and other languages have, and back.
constexpr Time unix_time(std::int64_t nanoseconds) {
  return Time(std::chrono::nanoseconds(nanoseconds));
}
constexpr std::int64_t unix_nanoseconds(Time time) {
  return time.time_since_epoch().count();
}

/// A time that is later by a period, or Time::max() if there is no such time. Neither is negative.
constexpr Time later(Time time, std::chrono::nanoseconds period) {
  return time > Time::max() - period ? Time::max() : time + period;
}

constexpr double seconds(std::chrono::nanoseconds period) {
  return static_cast<double>(period.count()) * 1e-9;
}

/// A duration given in seconds, limited to 292 years; 0 for NaN.
constexpr std::chrono::nanoseconds duration(double seconds) {
  constexpr double kLongest = 9.2e18;  // [ns]
  if (!(seconds == seconds)) return {};
  return std::chrono::nanoseconds(
      static_cast<std::int64_t>(std::clamp(seconds * 1e9, -kLongest, kLongest)));
}

}  // namespace hc
