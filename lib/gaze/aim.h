// SPDX-License-Identifier: Apache-2.0
#pragma once
// The orientation in which a pan-tilt head looks at a place. Pure.

#include <Eigen/Geometry>

namespace hc::gaze {

/// Orientation of a pan-tilt unit: T_robot_head = Rz(pan) Ry(tilt). [rad]
struct Angles {
  double pan = 0;   ///< > 0: to the left
  double tilt = 0;  ///< > 0: down
};

/// Turns vectors of the head (x forward, y left, z up) into the robot's frame.
Eigen::Quaterniond rotation(const Angles& angles);
/// The angles of such a rotation; a roll is ignored.
Angles angles_of(const Eigen::Quaterniond& R_robot_head);
/// The angle between two directions of gaze, 0 … π [rad].
double between(const Angles& a, const Angles& b);

/// An eye in the head: what it looks along.
struct Sight {
  Eigen::Vector3d place;      ///< [m]
  Eigen::Vector3d direction;  ///< of length 1
};

/// The orientation of the head in which an eye of it looks at a place.
///
/// @param p_robot  the place, in the frame whose origin is where the unit's axes meet [m].
/// A place nearer to the axes than the eye cannot be looked at; the result is then of no use, and
/// finite.
Angles aim(const Eigen::Vector3d& p_robot, const Sight& eye);

}  // namespace hc::gaze
