// SPDX-License-Identifier: Apache-2.0
#pragma once
// The motion of the ball over time: to and fro along an arc around the robot. Pure.

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <room/chance.h>

namespace hc::room {

struct BallMotion {
  std::string kind = "roll";  ///< still, roll, bounce, or hide (roll with rests behind the screen)
  double speed = 0.349;       ///< as seen from the robot [rad/s]
  double hidden = 2.0;        ///< duration of rests behind the screen [s]
  std::uint64_t seed = 1;     ///< of the turning points
};

/// A ball of kBallRadius on an arc around the robot's axis.
class Ball {
 public:
  explicit Ball(const BallMotion& motion);

  /// The ball's centre and velocity in the world [m, m/s].
  struct State {
    Eigen::Vector3d position, velocity;
  };
  [[nodiscard]] State at(double t);

 private:
  /// A motion from one rest to the next.
  struct Leg {
    double begin, from, to, end;  // [s], [rad], [rad], end of the rest [s]
  };
  void add_leg();

  BallMotion motion_;
  Chance chance_;
  std::vector<Leg> legs_;
};

inline constexpr double kBallRadius = 0.10;    ///< [m]
inline constexpr double kArcRadius = 2.4;      ///< from the robot's axis to the ball's centre [m]
inline constexpr double kArcHeight = 0.55;     ///< of the bench on which it rolls, in the world [m]
inline constexpr double kArcEnd = 0.87;        ///< maximum angle of the ball on either side [rad]
inline constexpr double kScreenAngle = -0.62;  ///< direction of the screen, to the right [rad]

}  // namespace hc::room
