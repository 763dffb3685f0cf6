// SPDX-License-Identifier: Apache-2.0
#pragma once
// The ears: the sounds of the room, in consecutive pieces without gaps.

#include <cstdint>
#include <span>

#include <Eigen/Geometry>

#include <hc/module/module.h>

#include <room/sounds.h>

class Ears {
 public:
  using Output = hc::Output<decltype(hc::sound(2))>;

  /// @param left, right  positions in the head's frame [m]. @param start  time of the first
  /// sample.
  Ears(const Eigen::Vector3d& left, const Eigen::Vector3d& right, Output sound, hc::Time start)
      : places_{left, right}, sound_(std::move(sound)), start_(start) {}

  /// Sends the sound since the last call, for this pose of the head and these places of the
  /// sources; skips the time by which the clock was set.
  void hear_until(hc::Time until, const Eigen::Isometry3d& T_world_head,
                  std::span<const hc::room::Source> sources);

 private:
  Eigen::Vector3d places_[2];
  Output sound_;
  hc::Time start_;
  std::int64_t sample_ = 0;  // next
};
