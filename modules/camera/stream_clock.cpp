// SPDX-License-Identifier: Apache-2.0
#include "stream_clock.h"

#include <algorithm>
#include <utility>

namespace {

constexpr std::chrono::seconds kPeriod{10};  // clocks drift by at most 1 ms meanwhile

}  // namespace

hc::MonotonicTime StreamClock::time_of(std::chrono::nanoseconds streamed,
                                       hc::MonotonicTime arrived) {
  if (last_ && streamed <= *last_) *this = {};
  last_ = streamed;
  if (arrived - period_begin_ > kPeriod) {
    least_before_ = std::exchange(least_, {});
    period_begin_ = arrived;
  }
  const auto offset = arrived - streamed;
  least_ = std::min(offset, least_.value_or(offset));
  return streamed + std::min(*least_, least_before_.value_or(*least_));
}
