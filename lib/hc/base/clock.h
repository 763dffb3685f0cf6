// SPDX-License-Identifier: Apache-2.0
#pragma once
// The two clocks: a monotonic one for every timer, and the wall clock that stamps messages.
// Tests turn a ManualClock by hand.

#include <atomic>
#include <chrono>
#include <cstdint>

namespace hc {

/// Time since some fixed moment; never goes back, whatever happens to the wall clock.
using MonotonicTime = std::chrono::nanoseconds;

/// Where the time comes from.
class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual MonotonicTime monotonic() const = 0;
  /// The header's `time` field. [ns since the Unix epoch, UTC]
  [[nodiscard]] virtual std::int64_t wall() const = 0;
};

/// The machine's clocks.
class SystemClock final : public Clock {
 public:
  [[nodiscard]] MonotonicTime monotonic() const override {
    return std::chrono::steady_clock::now().time_since_epoch();
  }
  [[nodiscard]] std::int64_t wall() const override {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
  }
};

/// A clock that stands still until it is told otherwise. One thread turns it, any may look.
class ManualClock final : public Clock {
 public:
  [[nodiscard]] MonotonicTime monotonic() const override { return monotonic_; }
  [[nodiscard]] std::int64_t wall() const override { return wall_; }
  void advance(std::chrono::nanoseconds by) {
    monotonic_ = monotonic() + by;
    wall_ += by.count();
  }
  void set_wall(std::int64_t time) { wall_ = time; }

 private:
  std::atomic<MonotonicTime> monotonic_{MonotonicTime(0)};
  std::atomic<std::int64_t> wall_ = 0;
};

}  // namespace hc
