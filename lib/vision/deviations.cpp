// SPDX-License-Identifier: Apache-2.0
// The covariance of the joint fit of two cameras, in linear approximation.
#include <vision/deviations.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <hc/base/format.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <opencv2/calib3d.hpp>

namespace hc::vision {
namespace {

// The numbers that all views share: of each camera fx, fy, cx, cy, k1, k2, p1, p2, k3; R, T.
constexpr int kLens = 9, kLeft = 0, kRight = kLens, kR = 2 * kLens, kT = kR + 3, kNumbers = kT + 3;
constexpr int kPose = 6;
using Shared = Eigen::Matrix<double, kNumbers, kNumbers>;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

RowMatrix matrix_of(const cv::Mat& mat) {
  return Eigen::Map<const RowMatrix>(mat.ptr<double>(), mat.rows, mat.cols);
}

/// Where points are projected, by the numbers of the projection.
struct Slopes {
  RowMatrix turn, shift, lens;  // (2 N, 3), (2 N, 3), (2 N, 9)
};

Slopes project(const std::vector<cv::Point3f>& points, const cv::Vec3d& turn,
               const cv::Vec3d& shift, const cv::Matx33d& M, const std::vector<double>& D,
               std::vector<cv::Point2f>* projected = nullptr) {
  std::vector<cv::Point2f> unused;
  cv::Mat slopes;
  cv::projectPoints(points, turn, shift, M, D, projected ? *projected : unused, slopes);
  const RowMatrix all = matrix_of(slopes);
  return {all.leftCols(3), all.middleCols(3, 3), all.middleCols(6, kLens)};
}

/// What a view says of the shared numbers, its pose being unknown.
Shared information(const StereoCalibration& c, const std::vector<cv::Point3f>& board,
                   const std::vector<cv::Point2f>& left) {
  cv::Vec3d turn, shift, R;
  cv::solvePnP(board, left, c.M1, c.D1, turn, shift);
  cv::Rodrigues(c.R, R);
  cv::Mat right_turn, right_shift, rr, rt, rR, rT, tr, tt, tR, tT;  // slopes of the right pose
  cv::composeRT(turn, shift, R, c.T, right_turn, right_shift, rr, rt, rR, rT, tr, tt, tR, tT);
  const Slopes one = project(board, turn, shift, c.M1, c.D1);
  const Slopes other = project(board, right_turn, right_shift, c.M2, c.D2);
  const auto rows = one.lens.rows();
  RowMatrix A = RowMatrix::Zero(2 * rows, kNumbers), B(2 * rows, kPose);
  A.block(0, kLeft, rows, kLens) = one.lens;
  B.topRows(rows) << one.turn, one.shift;
  A.block(rows, kRight, rows, kLens) = other.lens;
  A.block(rows, kR, rows, 3) = other.turn * matrix_of(rR) + other.shift * matrix_of(tR);
  A.block(rows, kT, rows, 3) = other.turn * matrix_of(rT) + other.shift * matrix_of(tT);
  B.bottomRows(rows) << other.turn * matrix_of(rr) + other.shift * matrix_of(tr),
      other.turn * matrix_of(rt) + other.shift * matrix_of(tt);
  const RowMatrix AB = A.transpose() * B, BB = B.transpose() * B;
  return A.transpose() * A - AB * BB.ldlt().solve(AB.transpose());
}

/// The inverse of an information matrix whose numbers are of different orders of magnitude; nothing
/// if it is singular.
std::optional<Shared> inverse(const Shared& information) {
  const Eigen::Matrix<double, kNumbers, 1> scale =
      information.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return std::nullopt;
  const Shared scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Shared> solver(scaled);
  constexpr double kSingular = 1e-13;
  if (!(solver.eigenvalues()[0] > kSingular)) return std::nullopt;
  return scale.asDiagonal() * solver.eigenvectors() *
         solver.eigenvalues().cwiseInverse().asDiagonal() * solver.eigenvectors().transpose() *
         scale.asDiagonal();
}

/// Deviation of the place in the right image of a far point at a pixel of the left one [px]; 0 if
/// the right camera does not see it.
double match_deviation(const StereoCalibration& c, const Shared& covariance, cv::Point2d pixel) {
  const cv::Vec2d ray = ray_of(c, Eye::Left, pixel);
  const std::vector<cv::Point3f> point = {
      {static_cast<float>(ray[0]), static_cast<float>(ray[1]), 1}};
  cv::Vec3d R;
  cv::Rodrigues(c.R, R);
  const Slopes one = project(point, {}, {}, c.M1, c.D1);
  std::vector<cv::Point2f> seen;
  const Slopes other = project(point, R, {}, c.M2, c.D2, &seen);
  if (!cv::Rect2f(cv::Point2f(), c.size).contains(seen[0])) return 0;
  // The ray of the pixel changes with the left lens.
  const Eigen::Matrix2d by_ray = one.shift.leftCols<2>();
  const Eigen::Matrix<double, 2, kLens> ray_by_lens = -by_ray.inverse() * one.lens;
  const Eigen::Matrix3d turned =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(c.R.val);
  Eigen::Matrix<double, 2, kNumbers> slopes = Eigen::Matrix<double, 2, kNumbers>::Zero();
  slopes.middleCols<kLens>(kLeft) = other.shift * turned.leftCols<2>() * ray_by_lens;
  slopes.middleCols<kLens>(kRight) = other.lens;
  slopes.middleCols<3>(kR) = other.turn;
  return std::sqrt((slopes * covariance * slopes.transpose()).diagonal().maxCoeff());
}

}  // namespace

Deviations deviations_of(const StereoCalibration& c,
                         const std::vector<std::vector<cv::Point3f>>& board,
                         const std::vector<std::vector<cv::Point2f>>& left) {
  Shared sum = Shared::Zero();
  std::size_t corners = 0;
  for (std::size_t view = 0; view < left.size(); ++view) {
    sum += information(c, board[view], left[view]);
    corners += left[view].size();
  }
  const auto unit = inverse(sum);
  if (!unit) return {};
  const auto numbers = 4 * static_cast<double>(corners);
  const double unknowns = kNumbers + kPose * static_cast<double>(left.size());
  // rms is of points, of two numbers each.
  const double variance = c.rms * c.rms / 2 * numbers / (numbers - unknowns);
  const Shared covariance = variance * *unit;
  const auto relative = [&](int at, double value) {
    return std::sqrt(covariance(at, at)) / std::abs(value);
  };
  Deviations result;
  result.focal = std::max({relative(kLeft, c.M1(0, 0)), relative(kLeft + 1, c.M1(1, 1)),
                           relative(kRight, c.M2(0, 0)), relative(kRight + 1, c.M2(1, 1))});
  const Eigen::Vector3d T(c.T[0], c.T[1], c.T[2]);
  result.baseline =
      std::sqrt(T.normalized().dot(covariance.block<3, 3>(kT, kT) * T.normalized())) / T.norm();
  result.match = 0;
  for (int row = -2; row <= 2; ++row)
    for (int column = -2; column <= 2; ++column)
      result.match = std::max(result.match, match_deviation(c, covariance,
                                                            {c.size.width * (0.5 + column / 6.0),
                                                             c.size.height * (0.5 + row / 6.0)}));
  return result;
}

Status Deviations::check() const {
  // Three standard deviations are 1.5 % and 3 px.
  constexpr double kMost = 0.005, kMostMatch = 1;
  const char* tail = " (standard deviation; at most 0.5 % is accepted)";
  if (!(focal <= kMost))
    return Error{
        Code::NotFound,
        hc::format("the views do not determine the focal length: ± {:.1f} %{}", 100 * focal, tail)};
  if (!(baseline <= kMost))
    return Error{Code::NotFound,
                 hc::format("the views do not determine the distance of the cameras: ± {:.1f} %{}",
                            100 * baseline, tail)};
  if (!(match <= kMostMatch))
    return Error{
        Code::NotFound,
        hc::format("the views do not determine the lenses at the images' edges: ± {:.1f} px "
                   "(standard deviation; at most 1 px is accepted)",
                   match)};
  return {};
}

}  // namespace hc::vision
