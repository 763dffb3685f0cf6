// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where the head is in the world, by the gazes that were told. Pure.

#include <cstdint>

#include <Eigen/Geometry>

#include <frames/track.h>

class Neck {
 public:
  /// Takes in how the head was turned. @param time  over 0 [ns].
  void add(std::int64_t time, const Eigen::Quaterniond& R_robot_head);

  /// Whether a gaze is still to come that tells more of a time; the head stands still without any.
  [[nodiscard]] bool awaits(std::int64_t time, std::int64_t now) const {
    return gazes_.awaits(time, now);
  }

  /// T_world_head at a time: between two gazes of a second or less what lies between, else the one
  /// told before, since the head rests while nothing tells of it; before all of them the first, and
  /// straight ahead without any.
  [[nodiscard]] Eigen::Isometry3d at(std::int64_t time) const;

 private:
  hc::frames::Track gazes_{hc::frames::Memory{}};
};
