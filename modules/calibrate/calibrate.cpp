// SPDX-License-Identifier: Apache-2.0
#include "calibrate.h"

#include <cmath>
#include <string>

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Turns vectors of an eye that sits as it should (x right, y down, z forward) into the head.
Matrix3d optical() {
  Matrix3d M;
  M << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return M;
}

Vector3d turn_of(const Matrix3d& R) {
  const AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

hc::Error too_little(const std::string& where) {
  return {hc::Code::NotFound, "too little is seen in both pictures " + where};
}

/// How one eye sits in the head.
hc::Result<Matrix3d> sit(const std::vector<HeadView>& views, cv::Mat HeadView::*eye,
                         const hc::vision::Intrinsics& camera, const Vector3d& middle) {
  const Matrix3d M0 = optical(), U0 = hc::gaze::rotation(views[0].unit).matrix();
  Matrix3d sum = Matrix3d::Zero();
  for (std::size_t k = 1; k < views.size(); ++k) {
    const Matrix3d U = U0.transpose() * hc::gaze::rotation(views[k].unit).matrix();
    const Matrix3d guess = M0.transpose() * U * M0;
    const auto matches = hc::vision::match(views[0].*eye, views[k].*eye, camera, guess);
    const auto pose =
        hc::vision::relative_pose(matches, camera, guess, M0.transpose() * (U * middle - middle));
    if (!pose) return too_little("of turn " + std::to_string(k));
    sum += turn_of(U) * turn_of(pose->R_a_b).transpose();
  }
  const Eigen::JacobiSVD<Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3d sign(1, 1, 1);
  sign.z() = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return Matrix3d(svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose());
}

}  // namespace

hc::Result<HeadCalibration> calibrate(const std::vector<HeadView>& views,
                                      const hc::vision::Intrinsics& camera,
                                      const Vector3d& middle) {
  HeadCalibration found;
  const Matrix3d none = Matrix3d::Identity();
  const auto matches = hc::vision::match(views[0].first, views[0].second, camera, none);
  const auto eyes = hc::vision::relative_pose(matches, camera, none, Vector3d::UnitX());
  if (!eyes) return too_little("of the eyes");
  found.rms = eyes->rms;
  // The right eye is on the right of the left one.
  found.swapped = eyes->t.x() < 0;
  auto first = sit(views, &HeadView::first, camera, middle);
  if (!first) return first.error();
  auto second = sit(views, &HeadView::second, camera, middle);
  if (!second) return second.error();
  const Matrix3d left = found.swapped ? *second : *first, right = found.swapped ? *first : *second;
  const Vector3d forward = left.col(2);
  found.zero = {std::atan2(forward.y(), forward.x()), -std::asin(forward.z())};
  const Matrix3d offset = left.transpose() * right;
  const Vector3d turn = turn_of(offset);
  found.offset_pitch = turn.x();
  found.offset_yaw = turn.y();
  found.offset_roll = turn.z();
  return found;
}
