// SPDX-License-Identifier: Apache-2.0
#pragma once
// When pairs of images are taken: pair n is taken n / rate after the start. Pure.

#include <cstdint>

#include <hc/base/clock.h>

/// When so many periods have passed, without adding up errors. [ns]
/// @param rate  [Hz]
std::int64_t period_end(std::int64_t number, double rate);

/// Whether a clock was set, or so much time was missed that nobody wants what it would have
/// brought: it is far from what was expected [ns].
bool was_set(std::int64_t now, std::int64_t expected);

class Schedule {
 public:
  /// @param start  time of pair 0 [ns]. @param rate  pairs a second, over 0 [Hz].
  Schedule(std::int64_t start, double rate) : start_(start), rate_(rate) {}

  /// Number and time [ns] of the pair that is next.
  [[nodiscard]] std::int64_t number() const { return number_; }
  [[nodiscard]] std::int64_t time() const { return start_ + period_end(number_, rate_); }
  /// From the start to the next pair [s].
  [[nodiscard]] double seconds() const { return hc::seconds(time() - start_); }
  /// Whether the next pair is the first that is taken of a second, counted in pairs.
  [[nodiscard]] bool begins_second() const;

  /// The next pair has been taken.
  void next() { last_ = number_++; }
  /// Skips pairs that could not be taken in time, but for the latest that is due, and for the
  /// first of all: it shows a recording when the world began. After a clock was set, they go on as
  /// they were.
  void catch_up(std::int64_t now);
  /// Whether the next pair is to be taken.
  /// @param gaze_is_awaited  where the head is then becomes known yet.
  [[nodiscard]] bool is_due(std::int64_t now, bool gaze_is_awaited) const {
    return now >= time() && !gaze_is_awaited;
  }

 private:
  std::int64_t start_;
  double rate_;
  std::int64_t number_ = 0;
  std::int64_t last_ = -1;  // that was taken
};
