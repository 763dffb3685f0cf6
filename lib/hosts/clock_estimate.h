// SPDX-License-Identifier: Apache-2.0
#pragma once
// How the clock of another host runs against ours, from exchanges of four timestamps. Pure.

#include <cstdint>
#include <deque>
#include <optional>

namespace hc::hosts {

/// An exchange: a question, sent and answered, by the clocks of both ends [ns].
struct Exchange {
  std::int64_t asked = 0;     ///< here
  std::int64_t taken = 0;     ///< there
  std::int64_t answered = 0;  ///< there
  std::int64_t received = 0;  ///< here
};

/// The difference of two clocks that both run on and are never set. Of the last eight exchanges the
/// one with the shortest delay counts, whose times are disturbed by the smallest amount.
/// Source: RFC 5905, section 8 (offset, delay) and section 10 (clock filter).
class ClockEstimate {
 public:
  void add(const Exchange& exchange);

  /// Whether there has been an exchange.
  [[nodiscard]] bool is_known() const { return !recent_.empty(); }
  /// The clock there less the clock here, when that is `here` [ns].
  [[nodiscard]] std::int64_t offset(std::int64_t here) const;
  /// By how much that can be wrong: half the delay, if all of it was one way, and what the clocks
  /// have drifted since [ns].
  [[nodiscard]] std::int64_t error(std::int64_t here) const;
  /// How much faster the clock there runs, by least squares; nothing while that is not known within
  /// some 50 ppm, which takes 4 s at the minimum.
  [[nodiscard]] std::optional<double> drift() const { return drift_; }
  /// The shortest delay of late, there and back [ns].
  [[nodiscard]] std::int64_t delay() const { return best_.delay; }

 private:
  struct Sample {
    std::int64_t here = 0, offset = 0, delay = 0;
  };

  void fit();

  std::deque<Sample> recent_;  // all of the last
  std::deque<Sample> best_ones_;
  Sample best_;
  std::optional<double> drift_;
  double doubt_ = 0;  // of it, standard deviation
};

}  // namespace hc::hosts
