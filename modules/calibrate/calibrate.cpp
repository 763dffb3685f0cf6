// SPDX-License-Identifier: Apache-2.0
#include "calibrate.h"

#include <cmath>
#include <string>
#include <utility>

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

/// A turn of the head as its axes and as an eye tell it: w in the head's frame, u in the eye's.
struct Turn {
  Vector3d w, u;
};

/// One eye.
struct Eye {
  cv::Mat HeadView::*picture;
  Vector3d built;          // where it is in the head if nothing is wrong [m]
  Matrix3d M = optical();  // how it sits in the head, as far as it is known
  Vector3d place = built;
  std::vector<hc::vision::Matches> matches = {};  // of the first stand with each other one
  std::vector<Turn> turns = {};

  /// The turns from the first stand to each other one, as this eye sees them.
  hc::Status see(const std::vector<HeadView>& views, const hc::vision::Intrinsics& camera) {
    turns.clear();
    const Matrix3d U0 = hc::gaze::rotation(views[0].unit).matrix();
    for (std::size_t k = 1; k < views.size(); ++k) {
      const Matrix3d U = U0.transpose() * hc::gaze::rotation(views[k].unit).matrix();
      const Matrix3d guess = M.transpose() * U * M;
      if (matches.size() < k)
        matches.push_back(hc::vision::match(views[0].*picture, views[k].*picture, camera, guess));
      const auto pose = hc::vision::relative_pose(matches[k - 1], camera, guess,
                                                  M.transpose() * (U * place - place), true);
      if (!pose) return too_little("of turn " + std::to_string(k));
      turns.push_back({turn_of(U), turn_of(pose->R_a_b)});
    }
    return {};
  }
};

/// The rotation M of which w = M u, nearly, for all.
Matrix3d align(const std::vector<Turn>& turns) {
  Matrix3d sum = Matrix3d::Zero();
  for (const auto& turn : turns) sum += turn.w * turn.u.transpose();
  const Eigen::JacobiSVD<Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

}  // namespace

hc::Result<HeadCalibration> calibrate(const std::vector<HeadView>& views,
                                      const hc::vision::Intrinsics& camera, const Vector3d& middle,
                                      double baseline) {
  HeadCalibration found;
  const auto matches =
      hc::vision::match(views[0].first, views[0].second, camera, Matrix3d::Identity());
  auto eyes = hc::vision::relative_pose(matches, camera, Matrix3d::Identity(), Vector3d::UnitX());
  if (!eyes) return too_little("of the eyes");
  // The right eye is on the right of the left one.
  found.swapped = eyes->t.x() < 0;
  const Vector3d aside(0, baseline / 2, 0);
  Eye left{&HeadView::first, middle + aside}, right{&HeadView::second, middle - aside};
  if (found.swapped) std::swap(left.picture, right.picture);
  Vector3d offset;
  // Where an eye moves as the head turns is known once it is known how it sits.
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    for (Eye* eye : {&left, &right})
      if (auto seen = eye->see(views, camera); !seen) return seen.error();
    // What both eyes see at once tells how one sits to the other.
    const Eye &first = found.swapped ? right : left, &second = found.swapped ? left : right;
    const Vector3d to_second = first.M.transpose() * (second.place - first.place);
    eyes = hc::vision::relative_pose(matches, camera, eyes->R_a_b, to_second, true);
    if (!eyes) return too_little("of the eyes");
    const Matrix3d R_left_right = found.swapped ? Matrix3d(eyes->R_a_b.transpose()) : eyes->R_a_b;
    offset = turn_of(R_left_right);
    // The right eye's turns, as the left one would see them.
    auto turns = left.turns;
    for (const auto& turn : right.turns) turns.push_back({turn.w, R_left_right * turn.u});
    left.M = align(turns);
    right.M = left.M * R_left_right;
    // The eyes sit on one bar, which looks where the left one does.
    for (Eye* eye : {&left, &right}) eye->place = left.M * optical().transpose() * eye->built;
  }
  found.rms = eyes->rms;
  found.offset_pitch = offset.x();
  found.offset_yaw = offset.y();
  found.offset_roll = offset.z();
  const Vector3d forward = left.M.col(2);
  found.zero = {std::atan2(forward.y(), forward.x()), -std::asin(forward.z())};
  return found;
}
