// SPDX-License-Identifier: Apache-2.0
#pragma once
// Estimates offset and drift of another host's clock from exchanges of four timestamps. Pure.

#include <deque>
#include <optional>

#include <hc/base/clock.h>

namespace hc::hosts {

/// Clocks of two hosts count as at most so far from zero, so that no difference overflows.
inline constexpr std::chrono::nanoseconds kMostApart = std::chrono::hours(95 * 365 * 24);

/// The timestamps of a request and its reply, each by the clock of the host named.
struct Exchange {
  MonotonicTime asked{0};     ///< here
  MonotonicTime taken{0};     ///< there
  MonotonicTime answered{0};  ///< there
  MonotonicTime received{0};  ///< here
};

/// The difference of two monotonic clocks. Uses the exchange with the shortest delay of the last
/// eight, which has the smallest error.
/// Source: RFC 5905, section 8 (offset, delay) and section 10 (clock filter).
class ClockEstimate {
 public:
  void add(const Exchange& exchange);

  /// Whether there has been an exchange.
  [[nodiscard]] bool is_known() const { return !recent_.empty(); }
  /// The other clock minus this one, at time `here`.
  [[nodiscard]] std::chrono::nanoseconds offset(MonotonicTime here) const;
  /// Bound on the error of offset(): half the delay, plus the drift since the exchange.
  [[nodiscard]] std::chrono::nanoseconds error(MonotonicTime here) const;
  /// Relative rate by which the other clock is faster, by least squares; nullopt until it is known
  /// within about 50 ppm, after 4 s at the earliest.
  [[nodiscard]] std::optional<double> drift() const { return drift_; }
  /// The shortest recent round trip.
  [[nodiscard]] std::chrono::nanoseconds delay() const { return best_.delay; }

 private:
  struct Sample {
    std::chrono::nanoseconds here{0}, offset{0}, delay{0};
  };

  void fit();

  std::deque<Sample> recent_;
  std::deque<Sample> best_ones_;
  Sample best_;
  std::optional<double> drift_;
  double doubt_ = 0;  // standard deviation of drift_
};

}  // namespace hc::hosts
