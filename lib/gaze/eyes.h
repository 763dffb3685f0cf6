// SPDX-License-Identifier: Apache-2.0
#pragma once
// Two eyes on a pan-tilt head: how they sit on it, and from pixels to places. Pure.

#include <array>
#include <optional>
#include <span>

#include <Eigen/Geometry>

#include <gaze/aim.h>
#include <hc/base/result.h>

namespace hc::gaze {

/// A rotation as a vector along its axis, as long as its angle [rad].
Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& R);

/// How the eyes sit on the head, as far as that is not as built. They sit on one bar, which looks
/// where the left eye does.
struct HeadCalibration {
  bool swapped = false;  ///< the left eye's picture comes as the right one's
  Angles zero;           ///< where the bar looks with the unit at 0
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< of the right eye, a rotation vector about
                                                     ///< the left one's x (pitch), y (yaw) and z
                                                     ///< (roll) [rad]
  double rms = 0;  ///< distance of matches from their epipolar lines [px]

  /// Turns vectors of the right eye into the left one's frame; both optical.
  [[nodiscard]] Eigen::Matrix3d R_left_right() const;
  /// swapped 0/1, zero pan, tilt, offset roll, pitch, yaw [rad], rms [px].
  [[nodiscard]] std::array<double, 7> numbers() const;
  /// Errors: Malformed (not 7 numbers, or what no head is like: not finite, a turn of more than
  /// 0.8 rad).
  static Result<HeadCalibration> of(std::span<const double> numbers);
};

enum class Side { Left, Right };

/// Two eyes of the same intrinsics, without distortion.
struct Eyes {
  double focal = 600;             ///< [px]
  double cx = 399.5, cy = 299.5;  ///< [px]
  double baseline = 0.1;          ///< the left one is to the left of the middle by half of it [m]
  Eigen::Vector3d middle = {0.06, 0, 0.05};  ///< the cyclopean eye in the head, as built [m]
  HeadCalibration calibration = {};

  /// Where the eye is in the head [m].
  [[nodiscard]] Eigen::Vector3d place(Side side) const;
  /// The eye between both.
  [[nodiscard]] Sight cyclopean() const;
  /// The direction in the head of what is seen at a pixel, of length 1.
  [[nodiscard]] Eigen::Vector3d direction(Side side, const Eigen::Vector2d& pixel) const;
  /// The place in the head that both eyes see, where the rays are nearest to one another [m];
  /// nothing if these do not meet before the head, or pass one another by more than `gap` of its
  /// distance.
  [[nodiscard]] std::optional<Eigen::Vector3d> place_of(const Eigen::Vector2d& left,
                                                        const Eigen::Vector2d& right,
                                                        double gap = 0.05) const;
};

}  // namespace hc::gaze
