// SPDX-License-Identifier: Apache-2.0
#pragma once
// Estimates offset and drift of another host's clock from exchanges of four timestamps. Pure.

#include <cstdint>
#include <deque>
#include <optional>

namespace hc::hosts {

/// The timestamps of a request and its reply, each by the clock of the host named [ns].
struct Exchange {
  std::int64_t asked = 0;     ///< here
  std::int64_t taken = 0;     ///< there
  std::int64_t answered = 0;  ///< there
  std::int64_t received = 0;  ///< here
};

/// The difference of two monotonic clocks. Uses the exchange with the shortest delay of the last
/// eight, which has the smallest error.
/// Source: RFC 5905, section 8 (offset, delay) and section 10 (clock filter).
class ClockEstimate {
 public:
  void add(const Exchange& exchange);

  /// Whether there has been an exchange.
  [[nodiscard]] bool is_known() const { return !recent_.empty(); }
  /// The other clock minus this one, at time `here` [ns].
  [[nodiscard]] std::int64_t offset(std::int64_t here) const;
  /// Bound on the error of offset(): half the delay, plus the drift since the exchange [ns].
  [[nodiscard]] std::int64_t error(std::int64_t here) const;
  /// Relative rate by which the other clock is faster, by least squares; nullopt until it is known
  /// within about 50 ppm, after 4 s at the earliest.
  [[nodiscard]] std::optional<double> drift() const { return drift_; }
  /// The shortest recent round trip [ns].
  [[nodiscard]] std::int64_t delay() const { return best_.delay; }

 private:
  struct Sample {
    std::int64_t here = 0, offset = 0, delay = 0;
  };

  void fit();

  std::deque<Sample> recent_;
  std::deque<Sample> best_ones_;
  Sample best_;
  std::optional<double> drift_;
  double doubt_ = 0;  // standard deviation of drift_
};

}  // namespace hc::hosts
