// SPDX-License-Identifier: Apache-2.0
#pragma once
// The two clocks: a monotonic one for every timer, and the wall clock that stamps messages.
// Tests turn a ManualClock by hand.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>

namespace hc {

/// Time since some fixed moment; never goes back, whatever happens to the wall clock.
using MonotonicTime = std::chrono::nanoseconds;

/// A time or period in seconds.
constexpr double seconds(std::int64_t nanoseconds) {
  return static_cast<double>(nanoseconds) * 1e-9;
}
constexpr double seconds(std::chrono::nanoseconds period) {
  return seconds(period.count());
}

/// The period of so many seconds; at most 292 years, and 0 where it is not a number.
constexpr std::chrono::nanoseconds duration(double seconds) {
  constexpr double kLongest = 9.2e18;  // [ns]
  if (!(seconds == seconds)) return {};
  return std::chrono::nanoseconds(
      static_cast<std::int64_t>(std::clamp(seconds * 1e9, -kLongest, kLongest)));
}

/// Where the time comes from.
class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual MonotonicTime monotonic() const = 0;
  /// The header's `time` field. [ns since the Unix epoch, UTC]
  [[nodiscard]] virtual std::int64_t wall() const = 0;
};

namespace internal {

/// The wall clock of another host, out of the monotonic clock of this one: it does not jump when
/// the wall clock of this host is set. Set by one thread, read by any.
class DistantWall {
 public:
  /// Has wall() give the monotonic clock plus `to_wall` [ns]. Where an earlier call has it give
  /// something else, it nears that by 1 ms per second, or jumps where it is more than 0.1 s off.
  void set(std::int64_t to_wall, MonotonicTime now);
  [[nodiscard]] bool is_set() const { return is_set_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::int64_t wall(MonotonicTime now) const;

 private:
  std::atomic<bool> is_set_ = false;
  mutable std::mutex mutex_;  // of what follows
  std::int64_t to_wall_ = 0, behind_ = 0;
  MonotonicTime since_{0};
};

/// The wall clock that SystemClock uses, where it is set (--wall_offset).
extern DistantWall distant_wall;

}  // namespace internal

/// The machine's clocks; in a module on another host than `hc run`, the wall clock of that.
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

/// A clock that a test sets. One thread turns it, any may look.
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
