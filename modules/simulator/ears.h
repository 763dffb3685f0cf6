// SPDX-License-Identifier: Apache-2.0
#pragma once
// The ears: give what they hear of the loudspeaker in the room, piece by piece without a gap.

#include <cstdint>

#include <Eigen/Geometry>

#include <hc/module/module.h>

class Ears {
 public:
  using Output = hc::Output<decltype(hc::sound(2))>;

  /// @param left, right  where they are in the head [m]. @param start  time of the first sample
  /// [ns].
  Ears(const Eigen::Vector3d& left, const Eigen::Vector3d& right, Output sound, std::int64_t start)
      : places_{left, right}, sound_(std::move(sound)), start_(start) {}

  /// Gives all that came since the last time, the head being there; what it would have to give for
  /// a clock that was set is left out. @param until  [ns]
  void hear_until(std::int64_t until, const Eigen::Isometry3d& T_world_head);

 private:
  Eigen::Vector3d places_[2];
  Output sound_;
  std::int64_t start_;
  std::int64_t sample_ = 0;  // the next
};
