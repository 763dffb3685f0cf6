// SPDX-License-Identifier: Apache-2.0
#pragma once
// How one frame moved in another, as far back as is remembered.
// Not safe for several threads at once; const calls alone are.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>

#include <frames/rigid.h>

namespace hc::frames {

/// How much of a movement is kept, and how far apart poses may be to interpolate between them.
/// What passes `span` or `poses` is forgotten, the oldest first.
struct Memory {
  std::chrono::nanoseconds span = std::chrono::seconds(10);  ///< before the latest time, over 0
  std::size_t poses = 4096;                                  ///< at least 1
  /// Between neighbours that are further apart nothing is known, over 0. One second is longer than
  /// any source of poses pauses that follows a movement, and a head turns away and back in it.
  std::chrono::nanoseconds gap = std::chrono::seconds(1);
};

/// From when to when something is known, both ends included [ns, as in a message's header].
struct TimeSpan {
  std::int64_t first = 0;
  std::int64_t last = std::numeric_limits<std::int64_t>::max();

  bool operator==(const TimeSpan&) const = default;
};

/// What became of a pose that was given.
enum class Fed {
  Added,     ///< it is kept, in its place by time
  Replaced,  ///< it is kept instead of another of the same time
  TooOld,    ///< it is not: it lies further back than is remembered
};

/// Poses by time.
class Track {
 public:
  explicit Track(const Memory& memory) : memory_(memory) {}

  /// Takes a pose in, in any order of time: the memory reaches back from the latest time of all.
  ///
  /// @param time  [ns], over 0.
  /// @param pose  finite, its quaternion of length 1.
  /// Cost: constant for the latest time; linear in the poses after it for an earlier one.
  Fed add(std::int64_t time, const Pose& pose);

  [[nodiscard]] bool empty() const { return samples_.empty(); }
  /// From the oldest to the latest pose, gaps included. Of an empty track: a bug.
  [[nodiscard]] TimeSpan known() const;

  /// The two poses around a time within known(), if too much time lies between them.
  /// Cost: logarithmic in the poses; no allocation.
  [[nodiscard]] std::optional<TimeSpan> gap_at(std::int64_t time) const;

  /// The latest times up to `time`, without a gap in them, of which something is known; nothing:
  /// all that is known is later.
  /// Cost: linear in the poses of that span.
  [[nodiscard]] std::optional<TimeSpan> known_until(std::int64_t time) const;

  /// The pose of that time, or what lies between its neighbours. A time outside known(), or in a
  /// gap: a bug.
  /// Cost: logarithmic in the poses; no allocation.
  [[nodiscard]] Pose at(std::int64_t time) const;

  /// The pose of any time, of what does not move unless a pose says so: before all that is known
  /// its first pose, after it the last, in a gap the one before it. Of an empty track: a bug. Cost:
  /// as at().
  [[nodiscard]] Pose nearest(std::int64_t time) const;

  void clear() { samples_.clear(); }

 private:
  struct Sample {
    std::int64_t time;
    Pose pose;
  };

  [[nodiscard]] std::deque<Sample>::const_iterator first_from(std::int64_t time) const;
  /// Times are over 0, so that no difference overflows.
  [[nodiscard]] bool is_gap(const Sample& before, const Sample& next) const {
    return next.time - before.time > memory_.gap.count();
  }

  Memory memory_;
  std::deque<Sample> samples_;  ///< by time, each time once
};

}  // namespace hc::frames
