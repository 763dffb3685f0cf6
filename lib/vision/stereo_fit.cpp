// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo_fit.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <hc/base/format.h>
#include <opencv2/calib3d.hpp>

namespace hc::vision {
namespace {

using Corners = std::vector<cv::Point2f>;

const cv::TermCriteria kUntil(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-7);

struct Points {
  std::vector<std::vector<cv::Point3f>> object;
  std::vector<Corners> left, right;
};

Calibrated solve(const Points& points, cv::Size size, std::vector<double>& errors) {
  Calibrated result;
  auto& c = result.calibration;
  c.size = size;
  cv::Mat M1, M2, D1, D2, R, T, E, F, per_view;
  std::vector<cv::Mat> turns, shifts;
  result.rms_left =
      cv::calibrateCamera(points.object, points.left, size, M1, D1, turns, shifts, 0, kUntil);
  result.rms_right =
      cv::calibrateCamera(points.object, points.right, size, M2, D2, turns, shifts, 0, kUntil);
  R = cv::Mat::eye(3, 3, CV_64F);
  T = cv::Mat::zeros(3, 1, CV_64F);
  c.rms = cv::stereoCalibrate(points.object, points.left, points.right, M1, D1, M2, D2, size, R, T,
                              E, F, per_view, cv::CALIB_USE_INTRINSIC_GUESS, kUntil);
  c.M1 = M1;
  c.M2 = M2;
  c.D1.assign(D1.begin<double>(), D1.end<double>());
  c.D2.assign(D2.begin<double>(), D2.end<double>());
  c.R = R;
  c.T = cv::Vec3d(T.reshape(1, 3));
  result.views = points.object.size();
  errors.clear();
  for (int view = 0; view < per_view.rows; ++view)
    errors.push_back(std::hypot(per_view.at<double>(view, 0), per_view.at<double>(view, 1)));
  return result;
}

/// Mean row difference of corresponding corners after rectification.
double epipolar_error(const StereoCalibration& c, const Points& points) {
  double sum = 0, count = 0;
  for (std::size_t view = 0; view < points.left.size(); ++view) {
    Corners left, right;
    cv::undistortPoints(points.left[view], left, c.M1, c.D1, c.R1, c.P1);
    cv::undistortPoints(points.right[view], right, c.M2, c.D2, c.R2, c.P2);
    for (std::size_t i = 0; i < left.size(); ++i) sum += std::abs(left[i].y - right[i].y);
    count += static_cast<double>(left.size());
  }
  return sum / count;
}

}  // namespace

Result<Calibrated> calibrate(std::span<const BoardView> views, const Board& board, cv::Size size) {
  HC_TRY(board.check());
  if (views.size() < kLeastViews)
    return Error{Code::NotFound, std::to_string(views.size()) + " views of the board, at least " +
                                     std::to_string(kLeastViews) + " are needed"};
  Points points;
  for (const auto& view : views) {
    points.object.push_back(view.on(board));
    points.left.push_back(view.left);
    points.right.push_back(view.right);
  }
  try {
    std::vector<double> errors;
    Calibrated result = solve(points, size, errors);
    const double rms_all = result.calibration.rms;
    const auto least = std::max(kLeastViews, (2 * views.size() + 2) / 3);
    constexpr double kOutlier = 3;  // times the median
    while (points.object.size() > least) {
      auto sorted = errors;
      std::sort(sorted.begin(), sorted.end());
      const auto worst = std::max_element(errors.begin(), errors.end()) - errors.begin();
      if (errors[static_cast<std::size_t>(worst)] <= kOutlier * sorted[sorted.size() / 2]) break;
      points.object.erase(points.object.begin() + worst);
      points.left.erase(points.left.begin() + worst);
      points.right.erase(points.right.begin() + worst);
      result = solve(points, size, errors);
    }
    result.deviations = deviations_of(result.calibration, points.object, points.left);
    HC_TRY(result.deviations.check());
    result.calibration.focal_deviation = result.deviations.focal;
    rectify(result.calibration);
    // Ensure that the result can be read again.
    HC_TRY(calibration_of(text_of(result.calibration)));
    result.rms_all = rms_all;
    result.given = views.size();
    result.epipolar = epipolar_error(result.calibration, points);
    return result;
  } catch (const cv::Exception& e) {
    return Error{Code::Malformed, "the views do not determine the cameras: " + e.err};
  }
}

double error_of(const StereoCalibration& c, std::span<const BoardView> views, const Board& board) {
  double sum = 0;
  std::size_t count = 0;
  for (const auto& view : views) {
    const auto corners = view.on(board);
    cv::Vec3d turn, shift, right_turn;
    cv::Matx33d turned;
    if (!cv::solvePnP(corners, view.left, c.M1, c.D1, turn, shift))
      return std::numeric_limits<double>::infinity();
    cv::Rodrigues(turn, turned);
    cv::Rodrigues(c.R * turned, right_turn);
    Corners left, right;
    cv::projectPoints(corners, turn, shift, c.M1, c.D1, left);
    cv::projectPoints(corners, right_turn, c.R * shift + c.T, c.M2, c.D2, right);
    sum += cv::norm(left, view.left, cv::NORM_L2SQR) + cv::norm(right, view.right, cv::NORM_L2SQR);
    count += 2 * corners.size();
  }
  return std::sqrt(sum / static_cast<double>(count));
}

std::array<double, 9> Calibrated::numbers() const {
  return {calibration.rms,
          rms_left,
          rms_right,
          epipolar,
          calibration.baseline(),
          static_cast<double>(views),
          deviations.focal,
          deviations.baseline,
          deviations.match};
}

std::string Calibrated::text() const {
  return hc::format(
      "rms {:.3f} px (left {:.3f}, right {:.3f}), rows differ by {:.3f} px, "
      "focal length {:.1f} px ± {:.2f} %, baseline {:.4f} m ± {:.2f} %, {} of {} views",
      calibration.rms, rms_left, rms_right, epipolar, calibration.M1(0, 0), 100 * deviations.focal,
      calibration.baseline(), 100 * deviations.baseline, views, given);
}

}  // namespace hc::vision
