// SPDX-License-Identifier: Apache-2.0
#pragma once
// The two clocks: a monotonic one for every timer, and the wall clock that stamps messages.
// Tests advance a ManualClock.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>

namespace hc {

/// Time since a fixed moment; never goes back, even if the wall clock is set.
using MonotonicTime = std::chrono::nanoseconds;

constexpr double seconds(std::int64_t nanoseconds) {
  return static_cast<double>(nanoseconds) * 1e-9;
}
constexpr double seconds(std::chrono::nanoseconds period) {
  return seconds(period.count());
}

/// A duration given in seconds, limited to 292 years; 0 for NaN.
constexpr std::chrono::nanoseconds duration(double seconds) {
  constexpr double kLongest = 9.2e18;  // [ns]
  if (!(seconds == seconds)) return {};
  return std::chrono::nanoseconds(
      static_cast<std::int64_t>(std::clamp(seconds * 1e9, -kLongest, kLongest)));
}

class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual MonotonicTime monotonic() const = 0;
  /// The header's `time` field. [ns since the Unix epoch, UTC]
  [[nodiscard]] virtual std::int64_t wall() const = 0;
};

namespace internal {

/// The wall clock of another host, derived from this host's monotonic clock: setting the wall clock
/// of this host does not make it jump. Set by one thread, read by any.
class DistantWall {
 public:
  /// Makes wall() the monotonic clock plus `to_wall` [ns]. A later call adjusts it gradually, by
  /// 1 ms per second; a difference of more than 0.1 s is stepped.
  void set(std::int64_t to_wall, MonotonicTime now);
  [[nodiscard]] bool is_set() const { return is_set_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::int64_t wall(MonotonicTime now) const;

 private:
  std::atomic<bool> is_set_ = false;
  mutable std::mutex mutex_;  // guards the members below
  std::int64_t to_wall_ = 0, behind_ = 0;
  MonotonicTime since_{0};
};

/// The wall clock that SystemClock uses once it is set (--wall_offset).
extern DistantWall distant_wall;

}  // namespace internal

/// The machine's clocks; in a module on another host than `hc run`, with the wall clock of the
/// latter.
class SystemClock final : public Clock {
 public:
  [[nodiscard]] MonotonicTime monotonic() const override {
    return std::chrono::steady_clock::now().time_since_epoch();
  }
  [[nodiscard]] std::int64_t wall() const override {
    if (internal::distant_wall.is_set()) [[unlikely]]
      return internal::distant_wall.wall(monotonic());
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
  }
};

/// A clock for tests. One thread advances it, any thread may read it.
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
