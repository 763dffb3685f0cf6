// SPDX-License-Identifier: Apache-2.0
#pragma once
// When to try again what has failed: after a pause that doubles with each failure. Pure.

#include <algorithm>
#include <chrono>
#include <utility>

#include <hc/base/clock.h>

namespace hc {

/// Pauses between attempts: 0.1 s after the first failure, then doubling up to 2 s.
///
///     if (device == nullptr && backoff.is_due(now)) {
///       device = open();
///       device == nullptr ? backoff.fail(now) : backoff.reset();
///     }
class Backoff {
 public:
  explicit Backoff(MonotonicTime first = std::chrono::milliseconds(100),
                   MonotonicTime longest = std::chrono::seconds(2))
      : first_(first), longest_(longest), pause_(first) {}

  /// Whether the next attempt may be made; also before the first.
  [[nodiscard]] bool is_due(MonotonicTime now) const { return now >= due_; }
  /// When it may be made; 0 before the first failure.
  [[nodiscard]] MonotonicTime due() const { return due_; }

  /// An attempt has failed.
  void fail(MonotonicTime now) { due_ = now + next(); }
  /// The same, for who waits without a loop: gives the pause.
  MonotonicTime next() { return std::exchange(pause_, std::min(2 * pause_, longest_)); }

  /// The next attempt may be made at once, and pauses start over.
  void reset() {
    due_ = {};
    pause_ = first_;
  }

 private:
  MonotonicTime first_, longest_, pause_, due_{0};
};

}  // namespace hc
