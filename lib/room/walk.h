// SPDX-License-Identifier: Apache-2.0
#pragma once
// How a person walks to and fro along a lane across the robot's view. Pure.

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <room/chance.h>

namespace hc::room {

inline constexpr double kWalkSpeed = 1.0;  ///< [m/s]
inline constexpr double kWalkEnd = 1.45;   ///< of a lane, on either side [m]

/// A lane, which is parallel to the world's y.
struct Lane {
  double x = 2;            ///< [m]
  double first = 0;        ///< where the walk begins, y [m]
  bool is_whole = false;   ///< from end to end; false: between random places
  std::uint64_t seed = 1;  ///< of the places and the rests
};

class Walk {
 public:
  explicit Walk(const Lane& lane);

  struct Step {
    Eigen::Vector2d place;  ///< in the world [m]
    double heading;         ///< of the chest, 0 being the world's x, > 0 to the left [rad]
    double speed;           ///< [m/s]
    double way;             ///< since the last rest [m]
  };
  [[nodiscard]] Step at(double t);

 private:
  /// Turns, walks, turns back to the robot, and rests.
  struct Leg {
    double begin, from, to, end;  // [s], y [m], y [m], [s]
  };
  void add_leg();

  Lane lane_;
  Chance chance_;
  std::vector<Leg> legs_;
};

/// The direction from a place to the robot's axis [rad].
double towards_robot(const Eigen::Vector2d& place);

}  // namespace hc::room
