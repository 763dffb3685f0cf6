// SPDX-License-Identifier: Apache-2.0
#include "calibrate.h"

#include <cmath>
#include <string>
#include <utility>

#include <vision/motion.h>
#include <vision/rectifier.h>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using hc::gaze::HeadCalibration;
using hc::vision::StereoCalibration;

hc::Error too_little(const std::string& where) {
  return {hc::Code::NotFound, "too few matches between the images " + where};
}

/// A rotation vector of the head: w in the head's frame, u in the eye's.
struct Turn {
  Vector3d w, u;
};

/// Spread of the turns about their second principal axis [rad²].
double spread(const std::vector<Turn>& turns) {
  Matrix3d sum = Matrix3d::Zero();
  for (const auto& turn : turns) sum += turn.w * turn.w.transpose();
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(sum, Eigen::EigenvaluesOnly).eigenvalues()[1];
}

/// One eye.
struct Eye {
  cv::Mat HeadView::*image;
  Eigen::Isometry3d T_head_mounted;
  Matrix3d M = T_head_mounted.linear();           // R_head_eye, refined in rounds
  Vector3d place = T_head_mounted.translation();  // [m]
  std::vector<hc::vision::Matches> matches = {};  // between the first pose and each other
  std::vector<Turn> turns = {};

  /// Measures the turns from the first pose to the others. Poses with too few matches are skipped,
  /// as long as turns about both axes remain.
  hc::Status see(const std::vector<HeadView>& views, const hc::vision::Intrinsics& camera,
                 const std::stop_token& stop) {
    turns.clear();
    const Matrix3d U0 = hc::gaze::rotation(views[0].unit).matrix();
    for (std::size_t k = 1; k < views.size(); ++k) {
      if (stop.stop_requested()) return hc::Error{hc::Code::Stopped, "asked to stop"};
      const Matrix3d U = U0.transpose() * hc::gaze::rotation(views[k].unit).matrix();
      const Matrix3d guess = M.transpose() * U * M;
      if (matches.size() < k)
        matches.push_back(hc::vision::match(views[0].*image, views[k].*image, camera, guess));
      const auto pose = hc::vision::relative_pose(matches[k - 1], camera, guess,
                                                  M.transpose() * (U * place - place), true);
      if (pose)
        turns.push_back({hc::gaze::rotation_vector(U), hc::gaze::rotation_vector(pose->R_a_b)});
    }
    constexpr double kLeast = 0.02;  // [rad²], a turn of 8°
    if (spread(turns) < kLeast) return too_little("as the head turns");
    return {};
  }
};

/// The rotation M that best fits w = M u for all turns (Kabsch).
Matrix3d align(const std::vector<Turn>& turns) {
  Matrix3d sum = Matrix3d::Zero();
  for (const auto& turn : turns) sum += turn.w * turn.u.transpose();
  const Eigen::JacobiSVD<Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

/// Views as seen by two identical cameras without distortion.
/// @param is_swapped  the first images are the right eye's.
hc::Result<std::vector<HeadView>> straightened(const std::vector<HeadView>& views,
                                               const StereoCalibration& cameras, bool is_swapped,
                                               const hc::vision::Intrinsics& ideal) {
  const cv::Size size = views[0].first.size();
  auto pinhole = hc::vision::ideal_pair(size, ideal.focal, 1);
  pinhole.M1 = cameras.M1;
  pinhole.M2 = cameras.M2;
  pinhole.D1 = cameras.D1;
  pinhole.D2 = cameras.D2;
  auto left = hc::vision::Rectifier::make(pinhole, hc::vision::Eye::Left, size);
  auto right = hc::vision::Rectifier::make(pinhole, hc::vision::Eye::Right, size);
  if (!left) return left.error();
  if (!right) return right.error();
  if (is_swapped) std::swap(left, right);
  std::vector<HeadView> straight;
  for (const auto& view : views) {
    straight.push_back({view.unit, {}, {}});
    left->rectify(view.first, straight.back().first);
    right->rectify(view.second, straight.back().second);
  }
  return straight;
}

hc::vision::Matches matches_of_eyes(const HeadView& view, const hc::vision::Intrinsics& camera) {
  return hc::vision::match(view.first, view.second, camera, Matrix3d::Identity());
}

/// Whether the first image is the right eye's.
hc::Result<bool> find_swapped(const HeadView& view, const hc::vision::Intrinsics& camera) {
  const auto eyes = hc::vision::relative_pose(matches_of_eyes(view, camera), camera,
                                              Matrix3d::Identity(), Vector3d::UnitX());
  if (!eyes) return too_little("of the eyes");
  return eyes->t.x() < 0;
}

/// Calibrates from views of two identical cameras without distortion.
hc::Result<HeadCalibration> solve(const std::vector<HeadView>& views, bool is_swapped,
                                  const hc::vision::Intrinsics& camera,
                                  const hc::gaze::Eyes& mounted, const std::stop_token& stop) {
  HeadCalibration found;
  found.swapped = is_swapped;
  const auto matches = matches_of_eyes(views[0], camera);
  using hc::gaze::Side;
  Eye left{&HeadView::first, mounted.T_head_eye(Side::Left)};
  Eye right{&HeadView::second, mounted.T_head_eye(Side::Right)};
  if (found.swapped) std::swap(left.image, right.image);
  // An eye's translation as the head turns depends on its mounting, so iterate.
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    for (Eye* eye : {&left, &right}) HC_TRY(eye->see(views, camera, stop));
    // Matches between the eyes give their mounting relative to each other.
    const Eye &first = found.swapped ? right : left, &second = found.swapped ? left : right;
    const Vector3d to_second = first.M.transpose() * (second.place - first.place);
    const auto eyes =
        hc::vision::relative_pose(matches, camera, first.M.transpose() * second.M, to_second, true);
    if (!eyes) return too_little("of the eyes");
    const Matrix3d R_left_right = found.swapped ? Matrix3d(eyes->R_a_b.transpose()) : eyes->R_a_b;
    found.rms = eyes->rms;
    found.offset = hc::gaze::rotation_vector(R_left_right);
    // The right eye's turns, in the left eye's frame.
    auto turns = left.turns;
    for (const auto& turn : right.turns) turns.push_back({turn.w, R_left_right * turn.u});
    left.M = align(turns);
    right.M = left.M * R_left_right;
    // Both eyes sit on one bar, which has the left eye's rotation.
    const Matrix3d bar = left.M * left.T_head_mounted.linear().transpose();
    for (Eye* eye : {&left, &right}) eye->place = bar * eye->T_head_mounted.translation();
  }
  const Vector3d forward = left.M.col(2);
  found.zero = {std::atan2(forward.y(), forward.x()), -std::asin(forward.z())};
  return found;
}

}  // namespace

hc::Result<HeadCalibration> calibrate(const std::vector<HeadView>& views,
                                      const StereoCalibration& cameras,
                                      const hc::gaze::Eyes& mounted, std::stop_token stop) {
  const cv::Size size = views[0].first.size();
  if (cameras.size.area() > 0 && cameras.size != size)
    return hc::Error{hc::Code::Unsupported, "the cameras' calibration is for images of " +
                                                std::to_string(cameras.size.width) + " x " +
                                                std::to_string(cameras.size.height)};
  const hc::vision::Intrinsics ideal{cameras.M1(0, 0), (size.width - 1) / 2.0,
                                     (size.height - 1) / 2.0};
  // Cameras can be assigned to images only once the eyes are identified.
  const auto first = HC_TRY(straightened({views[0]}, cameras, false, ideal));
  const auto is_swapped = HC_TRY(find_swapped(first.front(), ideal));
  const auto straight = HC_TRY(straightened(views, cameras, is_swapped, ideal));
  auto found = solve(straight, is_swapped, ideal, mounted, stop);
  constexpr double kAgrees = 0.005;  // [rad]
  const Matrix3d measured = cameras.R_left_right();
  if (found && cameras.rms > 0 &&
      hc::gaze::rotation_vector(measured.transpose() * found->R_left_right()).norm() < kAgrees)
    found->offset = hc::gaze::rotation_vector(measured);
  return found;
}
