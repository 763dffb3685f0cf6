// SPDX-License-Identifier: Apache-2.0
#pragma once
// The times of pairs of images: pair n is taken n / rate after the start. Pure.

#include <cstdint>

#include <hc/base/clock.h>

/// The end of a number of periods, without accumulating rounding errors.
/// @param rate  [Hz].
std::chrono::nanoseconds period_end(std::int64_t number, double rate);

/// Whether the clock was set, or too much time was lost to catch up: it is far from the expected
/// time.
bool was_set(hc::Time now, hc::Time expected);

class Schedule {
 public:
  /// @param start  time of pair 0. @param rate  of pairs, > 0 [Hz].
  Schedule(hc::Time start, double rate) : start_(start), rate_(rate) {}

  /// Number and time of the next pair.
  [[nodiscard]] std::int64_t number() const { return number_; }
  [[nodiscard]] hc::Time time() const { return start_ + period_end(number_, rate_); }
  /// From the start to the next pair [s].
  [[nodiscard]] double seconds() const { return hc::seconds(time() - start_); }
  /// Whether the next pair is the first taken in a second, counted in pairs.
  [[nodiscard]] bool begins_second() const;

  /// Advances to the pair after the next.
  void next() { last_ = number_++; }
  /// Skips overdue pairs except the latest, and except pair 0, which marks the start in a
  /// recording. After the clock was set, continues without skipping.
  void catch_up(hc::Time now);
  /// Whether to take the next pair now.
  /// @param gaze_is_awaited  the head's pose at that time is still to come.
  [[nodiscard]] bool is_due(hc::Time now, bool gaze_is_awaited) const {
    return now >= time() && !gaze_is_awaited;
  }

 private:
  hc::Time start_;
  double rate_;
  std::int64_t number_ = 0;
  std::int64_t last_ = -1;  // last pair taken
};
