// SPDX-License-Identifier: Apache-2.0
#pragma once
// When to retry: after a pause that doubles with each failure. Pure.

#include <algorithm>
#include <chrono>
#include <utility>

namespace hc {

/// Pauses between attempts: 0.1 s after the first failure, then doubling up to 2 s.
///
///     if (device == nullptr && backoff.is_due(now)) {
///       device = open();
///       device == nullptr ? backoff.fail(now) : backoff.reset();
///     }
class Backoff {
 public:
  /// Time since any moment, of a clock that never goes back, and spans of it.
  using Time = std::chrono::nanoseconds;

  explicit Backoff(Time first = std::chrono::milliseconds(100),
                   Time longest = std::chrono::seconds(2))
      : first_(first), longest_(longest), pause_(first) {}

  /// Whether the next attempt may be made; also before the first.
  [[nodiscard]] bool is_due(Time now) const { return now >= due_; }
  /// When the next attempt may be made; 0 before the first failure.
  [[nodiscard]] Time due() const { return due_; }

  void fail(Time now) { due_ = now + next(); }
  /// For a caller that sleeps by itself: records a failed attempt and returns the pause.
  Time next() { return std::exchange(pause_, std::min(2 * pause_, longest_)); }

  /// Makes the next attempt due at once and starts again with the shortest pause.
  void reset() {
    due_ = {};
    pause_ = first_;
  }

 private:
  Time first_, longest_, pause_, due_{0};
};

}  // namespace hc
