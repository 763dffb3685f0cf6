// SPDX-License-Identifier: Apache-2.0
#include <hosts/clock_estimate.h>

#include <algorithm>

namespace hc::hosts {
namespace {

constexpr std::size_t kRecent = 8, kFitted = 64;
constexpr double kFitSpan = 4e9;          // of the first fit [ns]
constexpr double kUnknownDrift = 500e-6;  // before; the maximum that Linux corrects a clock by
constexpr double kFittedDrift = 15e-6;    // source: PHI of RFC 5905, section 7.3

}  // namespace

void ClockEstimate::add(const Exchange& exchange) {
  const auto& [asked, taken, answered, received] = exchange;
  // Differences first: the clocks may be far apart.
  const Sample sample{asked + (received - asked) / 2, ((taken - asked) + (answered - received)) / 2,
                      std::max<std::int64_t>(0, (received - asked) - (answered - taken))};
  recent_.push_back(sample);
  if (recent_.size() > kRecent) recent_.pop_front();
  best_ = *std::min_element(recent_.begin(), recent_.end(),
                            [](const auto& a, const auto& b) { return a.delay < b.delay; });
  if (!best_ones_.empty() && best_ones_.back().here >= best_.here) return;
  best_ones_.push_back(best_);
  if (best_ones_.size() > kFitted) best_ones_.pop_front();
  fit();
}

void ClockEstimate::fit() {
  const auto& first = best_ones_.front();
  if (static_cast<double>(best_.here - first.here) < kFitSpan) return;
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto count = static_cast<double>(best_ones_.size());
  for (const auto& each : best_ones_) {
    const auto dx = static_cast<double>(each.here - first.here),
               dy = static_cast<double>(each.offset - first.offset);
    x += dx;
    y += dy;
    xx += dx * dx;
    xy += dx * dy;
  }
  const double spread = count * xx - x * x;
  if (spread > 0) drift_ = std::clamp((count * xy - x * y) / spread, -kUnknownDrift, kUnknownDrift);
}

std::int64_t ClockEstimate::offset(std::int64_t here) const {
  return best_.offset +
         static_cast<std::int64_t>(drift_.value_or(0) * static_cast<double>(here - best_.here));
}

std::int64_t ClockEstimate::error(std::int64_t here) const {
  const double age = static_cast<double>(std::max<std::int64_t>(0, here - best_.here));
  return best_.delay / 2 + static_cast<std::int64_t>((drift_ ? kFittedDrift : kUnknownDrift) * age);
}

}  // namespace hc::hosts
