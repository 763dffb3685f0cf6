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

/// Turns vectors of an optical frame (x right, y down, z forward) into that of who looks the same
/// way (x forward, y left, z up).
Eigen::Matrix3d optical();

/// How the eyes sit on the head where that differs from how they were mounted. They sit on one bar.
struct HeadCalibration {
  bool swapped = false;  ///< the left eye's image comes as the right one's
  Angles zero;           ///< where the left eye looks with the unit at 0
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< of the right eye, a rotation vector about
                                                     ///< the left one's x (pitch), y (yaw) and z
                                                     ///< (roll) [rad]
  double rms = 0;  ///< distance of matches from their epipolar lines [px]

  /// Turns vectors of the right eye into the left one's frame; both optical.
  [[nodiscard]] Eigen::Matrix3d R_left_right() const;
  /// swapped 0/1, zero pan, tilt, offset roll, pitch, yaw [rad], rms [px].
  [[nodiscard]] std::array<double, 7> numbers() const;
  /// Errors: Malformed (not 7 numbers; not finite, a turn of more than 0.8 rad).
  static Result<HeadCalibration> of(std::span<const double> numbers);
};

enum class Side { Left, Right };

/// Two eyes of the same intrinsics, without distortion. Poses are T_head_eye: from an eye's optical
/// frame (x right, y down, z forward) into the head's, origin where the unit's axes meet [m].
class Eyes {
 public:
  double focal = 600;             ///< [px]
  double cx = 399.5, cy = 299.5;  ///< [px]

  /// Eyes as they are mounted.
  Eyes(const Eigen::Isometry3d& T_head_left, const Eigen::Isometry3d& T_head_right)
      : mounted_{T_head_left, T_head_right}, T_head_eye_{T_head_left, T_head_right} {}

  /// Sets the measured distance between the eyes; their middle stays where it is [m].
  void set_baseline(double baseline);
  [[nodiscard]] double baseline() const;
  /// Sets the measured rotation between the eyes, R_left_right; the left eye stays as it is.
  void set_offset(const Eigen::Matrix3d& R_left_right);
  /// Sets the measured mounting: the bar that the eyes are mounted on is turned about the unit's
  /// axes, so that the left eye looks to `zero`.
  void calibrate(const HeadCalibration& calibration);

  [[nodiscard]] bool swapped() const { return swapped_; }
  [[nodiscard]] const Eigen::Isometry3d& T_head_eye(Side side) const {
    return T_head_eye_[side == Side::Left ? 0 : 1];
  }
  /// Where the eye is in the head [m].
  [[nodiscard]] Eigen::Vector3d place(Side side) const { return T_head_eye(side).translation(); }
  /// The eye between both; it looks where the left one does.
  [[nodiscard]] Sight cyclopean() const;
  /// The direction in the head of what is seen at a pixel, of length 1.
  [[nodiscard]] Eigen::Vector3d direction(Side side, const Eigen::Vector2d& pixel) const;
  /// The place in the head that both eyes see, where the rays are nearest to one another [m];
  /// nothing if these do not meet before the head, or pass one another by more than `gap` of its
  /// distance.
  [[nodiscard]] std::optional<Eigen::Vector3d> place_of(const Eigen::Vector2d& left,
                                                        const Eigen::Vector2d& right,
                                                        double gap = 0.05) const;

 private:
  std::array<Eigen::Isometry3d, 2> mounted_, T_head_eye_;  // left, right
  bool swapped_ = false;
};

}  // namespace hc::gaze
