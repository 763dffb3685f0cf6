// SPDX-License-Identifier: Apache-2.0
#pragma once
// The orientation in which a pan-tilt head looks at a point. Pure.

#include <Eigen/Geometry>

namespace hc::gaze {

/// Orientation of a pan-tilt unit: T_robot_head = Rz(pan) Ry(tilt) [rad].
struct Angles {
  double pan = 0;   ///< > 0: left
  double tilt = 0;  ///< > 0: down
};

/// Rotates vectors from the head's frame (x forward, y left, z up) to the robot's.
Eigen::Quaterniond rotation(const Angles& angles);
/// The angles of such a rotation; ignores roll.
Angles angles_of(const Eigen::Quaterniond& R_robot_head);
/// The angle between two directions of gaze, 0 … π [rad].
double between(const Angles& a, const Angles& b);

/// The ray of an eye in the head's frame.
struct Sight {
  Eigen::Vector3d place;      ///< [m]
  Eigen::Vector3d direction;  ///< of length 1
};

/// The orientation of the head in which an eye looks at a point.
///
/// @param p_robot  in the frame whose origin is the intersection of the unit's axes [m]. A point
///     nearer to the axes than the eye cannot be looked at: the result is meaningless but finite.
Angles aim(const Eigen::Vector3d& p_robot, const Sight& eye);

}  // namespace hc::gaze
