// SPDX-License-Identifier: Apache-2.0
#pragma once
// How the ball moves: along an arc around the robot, to and fro, as a function of time. Pure.

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace hc::room {

/// What the ball does.
struct BallMotion {
  std::string kind = "roll";  ///< still, roll, bounce or hide (rolls, and rests behind the screen)
  double speed = 0.349;       ///< seen from the robot [rad/s]
  double hidden = 2.0;        ///< how long it rests behind the screen [s]
  std::uint64_t seed = 1;     ///< of where it turns round
};

/// Where a ball of kBallRadius is, as seen from above the robot: the arc has the robot's axis in
/// its middle.
class Ball {
 public:
  explicit Ball(const BallMotion& motion);

  /// The middle of the ball and its velocity in the world [m, m/s].
  ///
  /// @param t  since the start, not below 0 [s].
  struct State {
    Eigen::Vector3d position, velocity;
  };
  [[nodiscard]] State at(double t);

 private:
  /// From one place of rest to the next.
  struct Leg {
    double begin, from, to, end;  // [s], [rad], [rad], [s]: when it has come to rest
  };
  void add_leg();
  [[nodiscard]] double random();  // 0 … 1

  BallMotion motion_;
  std::uint64_t state_;
  std::vector<Leg> legs_;
};

inline constexpr double kBallRadius = 0.10;    ///< [m]
inline constexpr double kArcRadius = 2.4;      ///< from the robot's axis to the ball's middle [m]
inline constexpr double kArcHeight = 0.55;     ///< of the bench on which it rolls, in the world [m]
inline constexpr double kArcEnd = 0.87;        ///< the ball turns before this, to either side [rad]
inline constexpr double kScreenAngle = -0.62;  ///< direction of the screen, to the right [rad]

}  // namespace hc::room
