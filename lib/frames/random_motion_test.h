// SPDX-License-Identifier: Apache-2.0
#pragma once
// Random transformations for tests, and an interpolation independent of the library.

#include <cmath>
#include <numbers>
#include <random>

#include <frames/rigid.h>

namespace hc::frames {

/// Evenly distributed rotations, translations within 2 m.
class RandomMotion {
 public:
  explicit RandomMotion(unsigned seed) : random_(seed) {}

  double number(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random_);
  }
  int whole(int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random_);
  }
  Eigen::Vector3d vector(double most) {
    return {number(-most, most), number(-most, most), number(-most, most)};
  }
  Eigen::Isometry3d transformation() {
    std::normal_distribution<double> normal;
    Eigen::Quaterniond q(normal(random_), normal(random_), normal(random_), normal(random_));
    Eigen::Isometry3d result = Eigen::Translation3d(vector(2)) * q.normalized();
    return result;
  }

 private:
  std::mt19937 random_;
};

/// Rodrigues' formula: the rotation by `angle` [rad] about `axis`, of length 1.
inline Eigen::Matrix3d turn(const Eigen::Vector3d& axis, double angle) {
  Eigen::Matrix3d k;
  k << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return Eigen::Matrix3d::Identity() + std::sin(angle) * k + (1 - std::cos(angle)) * k * k;
}

/// a · (a⁻¹ b)^share for the rotations, by axis and angle: no quaternions, no slerp.
inline Eigen::Matrix4d interpolated(const Eigen::Matrix4d& a, const Eigen::Matrix4d& b,
                                    double share) {
  Eigen::Matrix3d ra = a.topLeftCorner<3, 3>(), rb = b.topLeftCorner<3, 3>();
  Eigen::Matrix3d d = ra.transpose() * rb;
  Eigen::Vector3d skew(d(2, 1) - d(1, 2), d(0, 2) - d(2, 0), d(1, 0) - d(0, 1));
  double angle = std::atan2(skew.norm(), d.trace() - 1);  // 2 sin, 2 cos
  Eigen::Matrix4d result = Eigen::Matrix4d::Identity();
  result.topLeftCorner<3, 3>() =
      skew.norm() == 0 ? ra : Eigen::Matrix3d(ra * turn(skew.normalized(), share * angle));
  result.topRightCorner<3, 1>() =
      a.topRightCorner<3, 1>() + share * (b.topRightCorner<3, 1>() - a.topRightCorner<3, 1>());
  return result;
}

}  // namespace hc::frames
