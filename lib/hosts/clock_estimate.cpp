// SPDX-License-Identifier: Apache-2.0
#include <hosts/clock_estimate.h>

#include <algorithm>
#include <cmath>

namespace hc::hosts {
namespace {

constexpr std::size_t kRecent = 8, kFitted = 64;
constexpr std::chrono::seconds kFitSpan{4};  // least span of a fit
constexpr double kUnknownDrift = 500e-6;  // before a fit: the largest correction that Linux makes
constexpr double kFittedDrift = 15e-6;    // source: PHI of RFC 5905, section 7.3
constexpr double kFittedDoubt = 25e-6;    // largest of a usable fit
constexpr double kLeastDoubt = 20e-6;     // of an exchange with the shortest delay [s]

}  // namespace

void ClockEstimate::add(const Exchange& exchange) {
  auto near = [](MonotonicTime time) { return std::clamp(time, -kMostApart, kMostApart); };
  const auto asked = near(exchange.asked), taken = near(exchange.taken),
             answered = near(exchange.answered), received = near(exchange.received);
  // Subtract first: the clocks may be far apart, and sums could overflow.
  const Sample sample{asked + (received - asked) / 2, ((taken - asked) + (answered - received)) / 2,
                      std::max(MonotonicTime(0), (received - asked) - (answered - taken))};
  recent_.push_back(sample);
  if (recent_.size() > kRecent) recent_.pop_front();
  best_ = *std::min_element(recent_.begin(), recent_.end(),
                            [](const auto& a, const auto& b) { return a.delay < b.delay; });
  if (!best_ones_.empty() && best_ones_.back().here >= best_.here) return;
  best_ones_.push_back(best_);
  if (best_ones_.size() > kFitted) best_ones_.pop_front();
  fit();
}

/// Weighted least squares. The excess of an exchange's delay over the shortest delay may have
/// occurred in either direction, so its offset is wrong by at most half of it.
void ClockEstimate::fit() {
  const auto& first = best_ones_.front();
  if (best_.here - first.here < kFitSpan) return;
  const auto shortest = std::ranges::min(best_ones_, {}, &Sample::delay).delay;
  double w = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& each : best_ones_) {
    const double doubt = kLeastDoubt + seconds(each.delay - shortest) / 2;
    const double weight = 1 / (doubt * doubt);
    const double dx = seconds(each.here - first.here), dy = seconds(each.offset - first.offset);
    w += weight;
    x += weight * dx;
    y += weight * dy;
    xx += weight * dx * dx;
    xy += weight * dx * dy;
  }
  const double spread = xx - x * x / w;
  if (spread <= 0) return;
  doubt_ = 1 / std::sqrt(spread);
  if (doubt_ > kFittedDoubt) return drift_.reset();
  drift_ = std::clamp((xy - x * y / w) / spread, -kUnknownDrift, kUnknownDrift);
}

std::chrono::nanoseconds ClockEstimate::offset(MonotonicTime here) const {
  return best_.offset + duration(drift_.value_or(0) * seconds(here - best_.here));
}

std::chrono::nanoseconds ClockEstimate::error(MonotonicTime here) const {
  const double age = std::max(0.0, seconds(here - best_.here));
  const double drift = drift_ ? kFittedDrift + 2 * doubt_ : kUnknownDrift;
  return best_.delay / 2 + duration(drift * age);
}

}  // namespace hc::hosts
