// SPDX-License-Identifier: Apache-2.0
#pragma once
// The two clocks: a monotonic one for every timer, and the wall clock that stamps messages.
// Tests advance a ManualClock.

#include <atomic>
#include <chrono>
#include <mutex>

#include <hc/base/time.h>

namespace hc {

class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual MonotonicTime monotonic() const = 0;
  /// The header's `time` field.
  [[nodiscard]] virtual Time wall() const = 0;
};

namespace internal {

/// The wall clock of another host, derived from this host's monotonic clock: setting the wall clock
/// of this host does not make it jump. Set by one thread, read by any.
class DistantWall {
 public:
  /// Makes wall() the monotonic clock plus `to_wall`, from 1970 to 2096. A later call adjusts it
  /// gradually, by 1 ms per second; a difference of more than 0.1 s is stepped.
  void set(std::chrono::nanoseconds to_wall, MonotonicTime now);
  [[nodiscard]] bool is_set() const { return is_set_.load(std::memory_order_relaxed); }
  [[nodiscard]] Time wall(MonotonicTime now) const;

 private:
  std::atomic<bool> is_set_ = false;
  mutable std::mutex mutex_;  // guards the members below
  std::chrono::nanoseconds to_wall_{0}, behind_{0};
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
  [[nodiscard]] Time wall() const override {
    if (internal::distant_wall.is_set()) [[unlikely]]
      return internal::distant_wall.wall(monotonic());
    return std::chrono::system_clock::now();
  }
};

/// A clock for tests. One thread advances it, any thread may read it.
class ManualClock final : public Clock {
 public:
  [[nodiscard]] MonotonicTime monotonic() const override { return monotonic_; }
  [[nodiscard]] Time wall() const override { return wall_; }
  void advance(std::chrono::nanoseconds by) {
    monotonic_ = monotonic() + by;
    wall_ = wall() + by;
  }
  void set_wall(Time time) { wall_ = time; }

 private:
  std::atomic<MonotonicTime> monotonic_{MonotonicTime(0)};
  std::atomic<Time> wall_{Time()};
};

}  // namespace hc
