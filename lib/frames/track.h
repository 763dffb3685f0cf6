// SPDX-License-Identifier: Apache-2.0
#pragma once
// The recent motion of one frame in another. Only const calls are thread-safe.

#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>

#include <frames/rigid.h>
#include <hc/base/time.h>

namespace hc::frames {

/// Limits of a track, beyond which the oldest poses are forgotten.
struct Memory {
  std::chrono::nanoseconds span = std::chrono::seconds(10);  ///< before the latest time, > 0
  std::size_t poses = 4096;                                  ///< at least 1
  /// No interpolation over a longer gap, > 0. One second is longer than the pauses of a source
  /// during a motion, and long enough for a head to turn away and back.
  std::chrono::nanoseconds gap = std::chrono::seconds(1);
};

/// A closed time interval.
struct TimeSpan {
  Time first;
  Time last = Time::max();

  bool operator==(const TimeSpan&) const = default;
};

/// The result of adding a pose.
enum class Fed {
  Added,     ///< inserted by time
  Replaced,  ///< replaced another of the same time
  TooOld,    ///< dropped: older than the memory
};

/// Poses by time.
class Track {
 public:
  explicit Track(const Memory& memory) : memory_(memory) {}

  /// Adds a pose, in any order of time; the memory reaches back from the latest time.
  ///
  /// @param time  after the Unix epoch.
  /// @param pose  finite, its quaternion of length 1.
  /// Cost: constant for the latest time; linear in the poses after it for an earlier one.
  Fed add(Time time, const Pose& pose);

  [[nodiscard]] bool empty() const { return samples_.empty(); }
  /// From the oldest to the latest pose, including gaps. The track must not be empty.
  [[nodiscard]] TimeSpan known() const;

  /// The gap at a time within known(), if any.
  /// Cost: logarithmic in the poses; no allocation.
  [[nodiscard]] std::optional<TimeSpan> gap_at(Time time) const;

  /// The latest known span up to `time` without a gap; nothing if all poses are later.
  /// Cost: linear in the poses of that span.
  [[nodiscard]] std::optional<TimeSpan> known_until(Time time) const;

  /// The pose at a time, interpolated. The time must be within known(), and not in a gap.
  /// Cost: logarithmic in the poses; no allocation.
  [[nodiscard]] Pose at(Time time) const;

  /// The pose at any time: before known() the first, after it the last, in a gap the previous one.
  /// The track must not be empty. Cost: as at().
  [[nodiscard]] Pose nearest(Time time) const;

  void clear() { samples_.clear(); }

 private:
  struct Sample {
    Time time;
    Pose pose;
  };

  [[nodiscard]] std::deque<Sample>::const_iterator first_from(Time time) const;
  /// Times are after the epoch, so that no difference overflows.
  [[nodiscard]] bool is_gap(const Sample& before, const Sample& next) const {
    return next.time - before.time > memory_.gap;
  }

  Memory memory_;
  std::deque<Sample> samples_;  ///< by time, each time once
};

}  // namespace hc::frames
