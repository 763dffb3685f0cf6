// SPDX-License-Identifier: Apache-2.0
#include "schedule.h"

#include <algorithm>
#include <cmath>

std::chrono::nanoseconds period_end(std::int64_t number, double rate) {
  return std::chrono::nanoseconds(
      static_cast<std::int64_t>(static_cast<long double>(number) * std::nano::den / rate));
}

bool was_set(hc::Time now, hc::Time expected) {
  constexpr std::chrono::seconds kMost{30};  // three periods of the slowest rate, 0.1 Hz
  return std::chrono::abs(now - expected) > kMost;
}

bool Schedule::begins_second() const {
  const std::int64_t pairs = std::max<std::int64_t>(1, std::llround(rate_));
  return last_ < 0 || number_ / pairs > last_ / pairs;
}

void Schedule::catch_up(hc::Time now) {
  if (number_ == 0) return;
  if (was_set(now, time())) start_ += now - time();
  const double passed = hc::seconds(now - start_);
  number_ = std::max(number_, static_cast<std::int64_t>(std::floor(passed * rate_)));
}
