// SPDX-License-Identifier: Apache-2.0
#pragma once
// The head's geometry: where its eyes and ears are in its frame, as built and as it should be.
// Pure.

#include <Eigen/Geometry>

/// How far above the origin of the world the head's is, at any gaze [m].
inline constexpr double kNeckHeight = 1.2;

/// What a real head has wrong, and a calibration finds. [rad]
struct HeadFaults {
  double zero_pan = 0, zero_tilt = 0;  ///< where the eyes look when the unit is at 0
  double offset_roll = 0, offset_pitch = 0, offset_yaw = 0;  ///< of the right eye, in its own frame
};

struct Head {
  double baseline = 0.1;  ///< between the eyes [m]
  HeadFaults faults;

  /// T_head_eye: the head's frame has its origin where pan and tilt axis meet (x forward, y left,
  /// z up), an eye's is optical (x right, y down, z forward).
  [[nodiscard]] Eigen::Isometry3d left_eye() const {
    return eye(baseline / 2, Eigen::Vector3d::Zero());
  }
  [[nodiscard]] Eigen::Isometry3d right_eye() const {
    return eye(-baseline / 2, {faults.offset_pitch, faults.offset_yaw, faults.offset_roll});
  }
  /// Where an ear is in the head: +1 the left one, -1 the right one [m].
  [[nodiscard]] static Eigen::Vector3d ear(int side) { return {0, 0.09 * side, 0.03}; }

 private:
  /// @param turned  about the eye's x (pitch), y (yaw) and z (roll) [rad].
  [[nodiscard]] Eigen::Isometry3d eye(double left, const Eigen::Vector3d& turned) const {
    using Eigen::AngleAxisd, Eigen::Vector3d;
    Eigen::Matrix3d optical;  // columns: the eye's axes in the head
    optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    const Eigen::Quaterniond misplaced = AngleAxisd(faults.zero_pan, Vector3d::UnitZ()) *
                                         AngleAxisd(faults.zero_tilt, Vector3d::UnitY());
    const Eigen::Quaterniond offset = AngleAxisd(turned.x(), Vector3d::UnitX()) *
                                      AngleAxisd(turned.y(), Vector3d::UnitY()) *
                                      AngleAxisd(turned.z(), Vector3d::UnitZ());
    return misplaced * Eigen::Translation3d(kForward, left, kUp) * Eigen::Isometry3d(optical) *
           offset;
  }
  static constexpr double kForward = 0.06, kUp = 0.05;  // of the eyes from the axes [m]
};
