// SPDX-License-Identifier: Apache-2.0
#include "schedule.h"

#include <algorithm>
#include <cmath>

std::int64_t period_end(std::int64_t number, double rate) {
  return static_cast<std::int64_t>(static_cast<long double>(number) * 1e9L / rate);
}

bool Schedule::begins_second() const {
  const std::int64_t pairs = std::max<std::int64_t>(1, std::llround(rate_));
  return last_ < 0 || number_ / pairs > last_ / pairs;
}

void Schedule::catch_up(std::int64_t now) {
  if (number_ == 0) return;
  const double passed = hc::seconds(now - start_);
  number_ = std::max(number_, static_cast<std::int64_t>(std::floor(passed * rate_)));
}
