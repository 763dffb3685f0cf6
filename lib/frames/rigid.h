// SPDX-License-Identifier: Apache-2.0
#pragma once
// Rigid transformations: validation and interpolation. Pure.
// T_to_from transforms points from `from` to `to`: p_to = T_to_from * p_from.

#include <Eigen/Geometry>

#include <hc/base/result.h>

namespace hc::frames {

/// Maximum deviation of a matrix from a rotation: largest element of RᵀR − 1 [1]. Numbers written
/// with four decimals pass, a scale of 0.1 % does not.
inline constexpr double kRotationTolerance = 1e-3;

/// A rigid transformation from a homogeneous matrix, whose numbers may be rounded: the rotation is
/// normalised via its quaternion.
///
/// @param matrix  (4, 4) f64: rotation in the upper left (3, 3), translation [m] in the last
///     column, last row 0 0 0 1.
///
/// Errors: Malformed (not finite; another last row; scaled, sheared or mirrored by more than
/// kRotationTolerance).
Result<Eigen::Isometry3d> rigid(const Eigen::Matrix4d& matrix);

/// The same from a translation and a quaternion of any length except zero.
///
/// @param p  origin of `from` in `to` [m].
/// @param q  rotates vectors from `from` to `to`; q and −q are equivalent.
///
/// Errors: Malformed (not finite; a quaternion of zeros).
Result<Eigen::Isometry3d> rigid(const Eigen::Vector3d& p, const Eigen::Quaterniond& q);

/// Rotation by roll φ about x, then pitch θ about y, then yaw ψ about z, about the fixed axes of
/// the target frame: R = Rz(ψ) Ry(θ) Rx(φ). Equivalent to yaw, then pitch about the rotated y, then
/// roll about the rotated x.
///
/// @param roll, pitch, yaw  [rad], right-handed. In a body's frame (x forward, y left, z up)
///     yaw > 0 turns left, pitch > 0 looks down, roll > 0 lowers the right side.
///
/// Source: REP 103, fixed axis roll, pitch, yaw.
Eigen::Quaterniond rotation(double roll, double pitch, double yaw);

/// Roll, pitch, yaw of a rotation, the inverse of rotation(): pitch within ±π/2; at ±π/2 yaw is 0
/// [rad].
Eigen::Vector3d angles_of(const Eigen::Matrix3d& R);

/// A rigid transformation in a form for interpolation.
struct Pose {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();            ///< [m]
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  ///< of length 1

  Pose() = default;
  explicit Pose(const Eigen::Isometry3d& transformation)
      : p(transformation.translation()), q(transformation.linear()) {}
  [[nodiscard]] Eigen::Isometry3d transformation() const { return Eigen::Translation3d(p) * q; }
};

/// Interpolates two poses: the translation along a straight line, the rotation at constant speed
/// about one axis, the shorter way round (either way at half a turn).
///
/// @param share  0 returns exactly `a`, 1 exactly `b` [1].
///
/// Source: Shoemake, Animating Rotation with Quaternion Curves, 1985 (slerp).
Pose between(const Pose& a, const Pose& b, double share);

}  // namespace hc::frames
