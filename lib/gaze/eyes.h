// SPDX-License-Identifier: Apache-2.0
#pragma once
// Two eyes on a pan-tilt head: their mounting, and triangulation. Pure.

#include <array>
#include <optional>
#include <span>

#include <Eigen/Geometry>

#include <gaze/aim.h>
#include <hc/base/result.h>

namespace hc::gaze {

/// The rotation vector of a rotation: along its axis, with the angle as length [rad].
Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& R);

/// Rotates vectors from an optical frame (x right, y down, z forward) to a body frame with the same
/// line of sight (x forward, y left, z up).
Eigen::Matrix3d optical();

/// Measured deviations from the nominal mounting of the eyes, which sit on one bar.
struct HeadCalibration {
  bool swapped = false;  ///< the eyes' images are swapped
  Angles zero;           ///< direction of the left eye with the unit at 0
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< of the right eye, a rotation vector about
                                                     ///< the left one's x (pitch), y (yaw) and z
                                                     ///< (roll) [rad]
  double rms = 0;  ///< distance of matches from their epipolar lines [px]

  /// Rotates vectors from the right eye's optical frame to the left one's.
  [[nodiscard]] Eigen::Matrix3d R_left_right() const;
  /// swapped 0/1, zero pan, tilt, offset roll, pitch, yaw [rad], rms [px].
  [[nodiscard]] std::array<double, 7> numbers() const;
  /// Errors: Malformed (not 7 numbers; not finite, a turn of more than 0.8 rad).
  static Result<HeadCalibration> of(std::span<const double> numbers);
};

enum class Side { Left, Right };

/// Two eyes with equal intrinsics, without distortion. Poses are T_head_eye: from an eye's optical
/// frame (x right, y down, z forward) to the head's, with the origin where the unit's axes meet
/// [m].
class Eyes {
 public:
  double focal = 600;             ///< [px]
  double cx = 399.5, cy = 299.5;  ///< [px]

  /// Eyes with their nominal mounting.
  Eyes(const Eigen::Isometry3d& T_head_left, const Eigen::Isometry3d& T_head_right)
      : mounted_{T_head_left, T_head_right}, T_head_eye_{T_head_left, T_head_right} {}

  /// Sets the measured distance between the eyes; keeps their midpoint [m].
  void set_baseline(double baseline);
  [[nodiscard]] double baseline() const;
  /// Sets the measured rotation between the eyes, R_left_right; keeps the left eye.
  void set_offset(const Eigen::Matrix3d& R_left_right);
  /// Sets the measured mounting: rotates the eyes' bar so that the left eye looks to `zero`.
  void calibrate(const HeadCalibration& calibration);

  [[nodiscard]] bool swapped() const { return swapped_; }
  [[nodiscard]] const Eigen::Isometry3d& T_head_eye(Side side) const {
    return T_head_eye_[side == Side::Left ? 0 : 1];
  }
  /// Position of the eye in the head's frame [m].
  [[nodiscard]] Eigen::Vector3d place(Side side) const { return T_head_eye(side).translation(); }
  /// The eye midway between both, with the direction of the left one.
  [[nodiscard]] Sight cyclopean() const;
  /// Direction of a pixel in the head's frame, of length 1.
  [[nodiscard]] Eigen::Vector3d direction(Side side, const Eigen::Vector2d& pixel) const;
  /// The triangulated point in the head's frame, where the rays are nearest to one another [m];
  /// nothing if it is behind the head, or the rays miss by more than `gap` of its distance.
  [[nodiscard]] std::optional<Eigen::Vector3d> place_of(const Eigen::Vector2d& left,
                                                        const Eigen::Vector2d& right,
                                                        double gap = 0.05) const;

 private:
  std::array<Eigen::Isometry3d, 2> mounted_, T_head_eye_;  // left, right
  bool swapped_ = false;
};

}  // namespace hc::gaze
