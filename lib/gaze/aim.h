// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where a pan-tilt head has to look: from pixels to directions, places and angles. Pure.

#include <optional>

#include <Eigen/Geometry>

namespace hc::gaze {

/// How a pan-tilt unit stands: T_robot_head = Rz(pan) Ry(tilt). [rad]
struct Angles {
  double pan = 0;   ///< > 0: to the left
  double tilt = 0;  ///< > 0: down
};

/// Turns vectors of the head (x forward, y left, z up) into the robot's frame.
Eigen::Quaterniond rotation(const Angles& angles);
/// The angles of such a rotation; a roll is left out.
Angles angles_of(const Eigen::Quaterniond& R_robot_head);
/// The angle between two directions of gaze, 0 … π [rad].
double between(const Angles& a, const Angles& b);

/// How the head has to stand for its cyclopean eye to look at a place.
///
/// @param p_robot  the place, in the frame whose origin is where the unit's axes meet [m].
/// @param eye  where the cyclopean eye is in the head [m]; it looks along the head's x.
/// A place nearer to the axes than the eye cannot be looked at; the result is then of no use, and
/// finite.
Angles aim(const Eigen::Vector3d& p_robot, const Eigen::Vector3d& eye);

/// Two eyes in the head, without distortion and of the same intrinsics.
struct Eyes {
  double focal = 600;             ///< [px]
  double cx = 399.5, cy = 299.5;  ///< [px]
  double baseline = 0.1;          ///< the left one is to the left of the middle by half of it [m]
  Eigen::Vector3d middle = {0.06, 0, 0.05};  ///< the cyclopean eye in the head [m]
  Eigen::Quaterniond R_left = Eigen::Quaterniond::Identity();  ///< as found by a calibration:
  Eigen::Quaterniond R_right =
      Eigen::Quaterniond::Identity();  ///< turns what is seen into the head

  /// Where the eye is [m]. @param side  +1 the left, -1 the right.
  [[nodiscard]] Eigen::Vector3d place(int side) const {
    return middle + Eigen::Vector3d(0, side * baseline / 2, 0);
  }
  /// The direction in the head of what is seen at a pixel, of length 1.
  [[nodiscard]] Eigen::Vector3d direction(int side, double u, double v) const;
  /// The place in the head that both eyes see, where the rays are nearest to one another [m];
  /// nothing if these do not meet before the head, or pass one another by more than `gap` of its
  /// distance.
  [[nodiscard]] std::optional<Eigen::Vector3d> place_of(const Eigen::Vector2d& left,
                                                        const Eigen::Vector2d& right,
                                                        double gap = 0.05) const;
};

}  // namespace hc::gaze
