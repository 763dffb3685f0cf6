// SPDX-License-Identifier: Apache-2.0
#include <vision/motion.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace hc::vision {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kLeast = 30;  // matches that agree
constexpr double kAgrees = 1.0;     // [px]

Matrix3d matrix(const Intrinsics& camera) {
  Matrix3d K;
  K << camera.focal, 0, camera.cx, 0, camera.focal, camera.cy, 0, 0, 1;
  return K;
}

cv::Matx33d as_cv(const Matrix3d& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Matrix3d turn(const Vector3d& by) {
  const double angle = by.norm();
  if (angle == 0) return Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, by / angle).matrix();
}

/// A motion with five degrees of freedom: three of R, two of the direction of t.
struct State {
  Matrix3d R;
  Vector3d t;

  [[nodiscard]] State moved(const Eigen::Matrix<double, 5, 1>& by) const {
    const Vector3d u = t.unitOrthogonal(), v = t.cross(u);
    return {R * turn(by.head<3>()), (t + by(3) * u + by(4) * v).normalized()};
  }
};

/// Sampson distances: approximate, signed [px].
Eigen::VectorXd errors(const State& state, const std::vector<Vector3d>& a,
                       const std::vector<Vector3d>& b, double focal) {
  const Matrix3d E = cross_matrix(state.t) * state.R;
  Eigen::VectorXd result(static_cast<Eigen::Index>(a.size()));
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vector3d line_in_a = E * b[i], line_in_b = E.transpose() * a[i];
    const double slope = line_in_a.head<2>().squaredNorm() + line_in_b.head<2>().squaredNorm();
    result(static_cast<Eigen::Index>(i)) = focal * a[i].dot(line_in_a) / std::sqrt(slope + 1e-18);
  }
  return result;
}

/// The number of matches with both depths above 0.
int in_front(const State& state, const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    // s a = z R b + t, least squares.
    const Vector3d turned_b = state.R * b[i];
    Eigen::Matrix2d normal;
    normal << a[i].dot(a[i]), -a[i].dot(turned_b), -a[i].dot(turned_b), turned_b.dot(turned_b);
    const Eigen::Vector2d depths =
        normal.inverse() * Eigen::Vector2d(a[i].dot(state.t), -turned_b.dot(state.t));
    if (depths(0) > 0 && depths(1) > 0) ++count;
  }
  return count;
}

/// Levenberg-Marquardt with Huber weights.
void refine(State& state, const std::vector<Vector3d>& a, const std::vector<Vector3d>& b,
            double focal, bool is_known) {
  constexpr int kSteps = 12;
  const int freedoms = is_known ? 3 : 5;
  constexpr double kStep = 1e-6;
  double damping = 1e-4;
  auto weigh = [](const Eigen::VectorXd& e) {
    return e.unaryExpr(
        [](double x) { return std::abs(x) <= kAgrees / 2 ? 1.0 : kAgrees / 2 / std::abs(x); });
  };
  auto e = errors(state, a, b, focal);
  for (int step = 0; step < kSteps; ++step) {
    Eigen::MatrixXd J(e.size(), freedoms);
    for (int k = 0; k < freedoms; ++k) {
      Eigen::Matrix<double, 5, 1> by = Eigen::Matrix<double, 5, 1>::Zero();
      by(k) = kStep;
      J.col(k) = (errors(state.moved(by), a, b, focal) - e) / kStep;
    }
    const Eigen::VectorXd w = weigh(e);
    Eigen::MatrixXd H = J.transpose() * w.asDiagonal() * J;
    const Eigen::VectorXd g = J.transpose() * w.asDiagonal() * e;
    H.diagonal() *= 1 + damping;
    Eigen::Matrix<double, 5, 1> by = Eigen::Matrix<double, 5, 1>::Zero();
    by.head(freedoms) = -H.ldlt().solve(g);
    const State next = state.moved(by);
    const auto next_e = errors(next, a, b, focal);
    if (next_e.cwiseAbs().cwiseMin(kAgrees * 3).sum() < e.cwiseAbs().cwiseMin(kAgrees * 3).sum()) {
      state = next;
      e = next_e;
      damping /= 10;
    } else {
      damping *= 10;
    }
  }
}

}  // namespace

Matches match(const cv::Mat& a, const cv::Mat& b, const Intrinsics& camera, const Matrix3d& R_a_b) {
  // Undo the rotation of b, so that the same things look the same.
  const Matrix3d homography = matrix(camera) * R_a_b * matrix(camera).inverse();
  cv::Mat turned;
  cv::warpPerspective(b, turned, as_cv(homography), a.size(), cv::INTER_LINEAR);
  std::vector<cv::Point2f> corners, found, back;
  constexpr int kMost = 800, kApart = 10;
  cv::goodFeaturesToTrack(a, corners, kMost, 0.005, kApart);
  if (corners.empty()) return {};
  std::vector<std::uint8_t> forward_ok, back_ok;
  const cv::Size window(21, 21);
  constexpr int kLevels = 4;
  cv::calcOpticalFlowPyrLK(a, turned, corners, found, forward_ok, cv::noArray(), window, kLevels);
  cv::calcOpticalFlowPyrLK(turned, a, found, back, back_ok, cv::noArray(), window, kLevels);
  std::vector<cv::Point2f> from, to;
  constexpr double kReturns = 0.3;  // [px]
  constexpr float kEdge = 11;
  const cv::Rect2f inside(kEdge, kEdge, static_cast<float>(a.cols) - 2 * kEdge,
                          static_cast<float>(a.rows) - 2 * kEdge);
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (forward_ok[i] != 0 && back_ok[i] != 0 && cv::norm(corners[i] - back[i]) < kReturns &&
        inside.contains(found[i])) {
      from.push_back(corners[i]);
      to.push_back(found[i]);
    }
  if (from.empty()) return {};
  cv::perspectiveTransform(to, to, as_cv(homography.inverse()));
  // Drop points warped from outside b.
  Matches matches;
  for (std::size_t i = 0; i < to.size(); ++i)
    if (inside.contains(to[i])) {
      matches.a.push_back(from[i]);
      matches.b.push_back(to[i]);
    }
  return matches;
}

std::optional<RelativePose> relative_pose(const Matches& matches, const Intrinsics& camera,
                                          const Matrix3d& R_a_b, const Vector3d& t, bool is_known) {
  std::vector<Vector3d> a, b;
  for (std::size_t i = 0; i < matches.a.size(); ++i) {
    auto ray = [&](const cv::Point2f& p) {
      return Vector3d((p.x - camera.cx) / camera.focal, (p.y - camera.cy) / camera.focal, 1);
    };
    a.push_back(ray(matches.a[i]));
    b.push_back(ray(matches.b[i]));
  }
  State state{R_a_b, t.normalized()};
  // Repeat without the outliers.
  for (double within : {8.0, 2.0, kAgrees}) {
    if (a.size() < kLeast) return std::nullopt;
    refine(state, a, b, camera.focal, is_known);
    const auto e = errors(state, a, b, camera.focal);
    std::vector<Vector3d> kept_a, kept_b;
    for (std::size_t i = 0; i < a.size(); ++i)
      if (std::abs(e(static_cast<Eigen::Index>(i))) < within) {
        kept_a.push_back(a[i]);
        kept_b.push_back(b[i]);
      }
    a = std::move(kept_a);
    b = std::move(kept_b);
  }
  if (a.size() < kLeast) return std::nullopt;
  refine(state, a, b, camera.focal, is_known);
  const State other{state.R, -state.t};
  if (in_front(other, a, b) > in_front(state, a, b)) state = other;
  const auto e = errors(state, a, b, camera.focal);
  return RelativePose{state.R, state.t, a.size(),
                      std::sqrt(e.squaredNorm() / static_cast<double>(e.size()))};
}

}  // namespace hc::vision
