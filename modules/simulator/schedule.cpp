// SPDX-License-Identifier: Apache-2.0
#include "schedule.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

std::int64_t period_end(std::int64_t number, double rate) {
  return static_cast<std::int64_t>(static_cast<long double>(number) * 1e9L / rate);
}

bool was_set(std::int64_t now, std::int64_t expected) {
  constexpr std::int64_t kMost = 30'000'000'000;  // three periods of the slowest rate, 0.1 Hz
  return std::abs(now - expected) > kMost;
}

bool Schedule::begins_second() const {
  const std::int64_t pairs = std::max<std::int64_t>(1, std::llround(rate_));
  return last_ < 0 || number_ / pairs > last_ / pairs;
}

void Schedule::catch_up(std::int64_t now) {
  if (number_ == 0) return;
  if (was_set(now, time())) start_ += now - time();
  const double passed = hc::seconds(now - start_);
  number_ = std::max(number_, static_cast<std::int64_t>(std::floor(passed * rate_)));
}
