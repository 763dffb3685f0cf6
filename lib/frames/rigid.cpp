// SPDX-License-Identifier: Apache-2.0
#include <frames/rigid.h>

#include <cmath>
#include <string>

namespace hc::frames {
namespace {

Error malformed(const std::string& what) {
  return Error{Code::Malformed, "frames: the transformation " + what};
}

}  // namespace

Result<Eigen::Isometry3d> rigid(const Eigen::Matrix4d& matrix) {
  if (!matrix.allFinite()) return malformed("has a number that is not finite");
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    return malformed("has another last row than 0 0 0 1");
  Eigen::Matrix3d r = matrix.topLeftCorner<3, 3>();
  // Larger elements are not of a rotation, and their squares may overflow.
  double off = r.cwiseAbs().maxCoeff() > 2
                   ? 3
                   : (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (off > kRotationTolerance)
    return malformed("is not rigid: its axes are not of length 1, or not at right angles");
  if (r.determinant() < 0) return malformed("is not rigid: it is a reflection");
  return rigid(matrix.topRightCorner<3, 1>(), Eigen::Quaterniond(r));
}

Result<Eigen::Isometry3d> rigid(const Eigen::Vector3d& p, const Eigen::Quaterniond& q) {
  if (!p.allFinite() || !q.coeffs().allFinite())
    return malformed("has a number that is not finite");
  double largest = q.coeffs().cwiseAbs().maxCoeff();
  if (largest == 0) return malformed("has a quaternion of zeros");
  // Scaled first, since squares of very large or small numbers overflow or underflow.
  Eigen::Quaterniond unit(Eigen::Vector4d(q.coeffs() / largest).normalized());
  Eigen::Isometry3d result = Eigen::Translation3d(p) * unit;
  return result;
}

Eigen::Quaterniond rotation(double roll, double pitch, double yaw) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
         AngleAxisd(roll, Vector3d::UnitX());
}

Eigen::Vector3d angles_of(const Eigen::Matrix3d& R) {
  constexpr double kUpright = 1e-9;  // gimbal lock: only yaw − roll or yaw + roll is known
  const double flat = std::hypot(R(0, 0), R(1, 0)), pitch = std::atan2(-R(2, 0), flat);
  if (flat < kUpright) return {std::atan2(-R(1, 2), R(1, 1)), pitch, 0};
  return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

Pose between(const Pose& a, const Pose& b, double share) {
  if (share == 0) return a;
  if (share == 1) return b;
  Pose result;
  result.p = (1 - share) * a.p + share * b.p;
  // Eigen takes the shorter way, and interpolates linearly if the turn is tiny.
  result.q = a.q.slerp(share, b.q).normalized();
  return result;
}

}  // namespace hc::frames
