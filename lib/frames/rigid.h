// SPDX-License-Identifier: Apache-2.0
#pragma once
// Rigid transformations: checked when they come from elsewhere, and what lies between two. Pure.
// T_to_from takes points in `from` to points in `to`: p_to = T_to_from * p_from.

#include <Eigen/Geometry>

#include <hc/base/result.h>

namespace hc::frames {

/// How far a matrix may be from a rotation, as the largest element of RᵀR − 1; [1]. Numbers written
/// with four decimals pass, a scale of 0.1 % does not.
inline constexpr double kRotationTolerance = 1e-3;

/// A rigid transformation out of a matrix on homogeneous coordinates, whose numbers may be rounded:
/// the rotation that comes out is that of its quaternion, made to be of length 1.
///
/// @param matrix  (4, 4) f64: rotation in the upper left (3, 3), translation [m] in the last
///     column, last row 0 0 0 1.
///
/// Errors: Malformed (not finite; another last row; scaled, sheared or mirrored by more than
/// kRotationTolerance).
Result<Eigen::Isometry3d> rigid(const Eigen::Matrix4d& matrix);

/// The same of a translation and a quaternion of any length but zero.
///
/// @param p  where the origin of `from` is in `to` [m].
/// @param q  turns vectors of `from` into `to`; q and −q are the same.
///
/// Errors: Malformed (not finite; a quaternion of zeros).
Result<Eigen::Isometry3d> rigid(const Eigen::Vector3d& p, const Eigen::Quaterniond& q);

/// Rotation by roll φ about x, then pitch θ about y, then yaw ψ about z, the axes being those of
/// the frame it leads to, which are fixed: R = Rz(ψ) Ry(θ) Rx(φ). That is yaw, then pitch about
/// the turned y, then roll about the turned x.
///
/// @param roll, pitch, yaw  [rad], right-handed. In a body's frame (x forward, y left, z up)
///     yaw > 0 turns to the left, pitch > 0 looks down, roll > 0 lowers the right side.
///
/// Source: REP 103, fixed axis roll, pitch, yaw.
Eigen::Quaterniond rotation(double roll, double pitch, double yaw);

/// Roll, pitch, yaw of a rotation, as rotation() takes them: pitch within ±π/2, where yaw is 0 at
/// ±π/2. [rad]
Eigen::Vector3d angles_of(const Eigen::Matrix3d& R);

/// A rigid transformation as what can be interpolated.
struct Pose {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();            ///< [m]
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  ///< of length 1

  Pose() = default;
  explicit Pose(const Eigen::Isometry3d& transformation)
      : p(transformation.translation()), q(transformation.linear()) {}
  [[nodiscard]] Eigen::Isometry3d transformation() const { return Eigen::Translation3d(p) * q; }
};

/// What lies between two poses: the translation moves along a straight line, the rotation by an
/// even turn about one axis, the shorter way round (either way at half a turn).
///
/// @param share  0 gives `a`, 1 gives `b`, to the bit. [1]
///
/// Source: Shoemake, Animating Rotation with Quaternion Curves, 1985 (slerp).
Pose between(const Pose& a, const Pose& b, double share);

}  // namespace hc::frames
