// SPDX-License-Identifier: Apache-2.0
#include "schedule.h"

#include <algorithm>
#include <cmath>

namespace {

constexpr std::int64_t kGazeLate = 100'000'000;  // a gaze that comes later is not waited for [ns]

}  // namespace

std::int64_t period_end(std::int64_t number, double rate) {
  return static_cast<std::int64_t>(static_cast<long double>(number) * 1e9L / rate);
}

bool Schedule::begins_second() const {
  return number_ % std::max<std::int64_t>(1, std::llround(rate_)) == 0;
}

void Schedule::catch_up(std::int64_t now) {
  const double passed = static_cast<double>(now - start_) * 1e-9;
  number_ = std::max(number_, static_cast<std::int64_t>(std::floor(passed * rate_)));
}

bool Schedule::is_due(std::int64_t now, bool gaze_is_known) const {
  return now >= time() && (gaze_is_known || now - time() >= kGazeLate);
}
