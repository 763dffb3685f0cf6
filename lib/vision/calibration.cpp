// SPDX-License-Identifier: Apache-2.0
#include <vision/calibration.h>

#include <algorithm>
#include <cmath>

#include <hc/base/format.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace hc::vision {
namespace {

using Corners = std::vector<cv::Point2f>;

/// Enlarges the image twofold if the board is too small to be found.
bool find_corners(const cv::Mat& image, const Board& board, Corners& corners) {
  if (image.empty()) return false;
  cv::Mat grey = image;
  if (image.channels() == 3) cv::cvtColor(image, grey, cv::COLOR_RGB2GRAY);
  const cv::Size size(board.columns, board.rows);
  // The fast check rejects images without a board in a tenth of the time.
  constexpr int kHow = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE;
  if (!cv::findChessboardCorners(grey, size, corners, kHow | cv::CALIB_CB_FAST_CHECK)) {
    cv::Mat larger;
    cv::resize(grey, larger, {}, 2, 2, cv::INTER_LINEAR);
    if (!cv::findChessboardCorners(larger, size, corners, kHow | cv::CALIB_CB_FAST_CHECK))
      return false;
    // The centre of the top left pixel is at (0.5, 0.5) in the larger image.
    for (auto& corner : corners) corner = (corner - cv::Point2f(0.5F, 0.5F)) * 0.5F;
  }
  // A window of half a square contains only one corner.
  double least = grey.cols;
  const auto columns = static_cast<std::size_t>(board.columns);
  for (std::size_t at = 0; at + 1 < corners.size(); ++at)
    if ((at + 1) % columns != 0) least = std::min(least, cv::norm(corners[at + 1] - corners[at]));
  const int half = std::clamp(static_cast<int>(least / 2), 2, 11);
  cv::cornerSubPix(grey, corners, {half, half}, {-1, -1},
                   {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-3});
  return true;
}

std::vector<cv::Point3f> object_points(const Board& board) {
  std::vector<cv::Point3f> points;
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column)
      points.emplace_back(static_cast<float>(column * board.square),
                          static_cast<float>(row * board.square), 0.0F);
  return points;
}

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

StereoCalibration ideal_pair(cv::Size size, double focal, double baseline) {
  StereoCalibration c;
  const double cx = (size.width - 1) / 2.0, cy = (size.height - 1) / 2.0;
  c.size = size;
  c.M1 = c.M2 = {focal, 0, cx, 0, focal, cy, 0, 0, 1};
  c.T = {-baseline, 0, 0};
  c.P1 = {focal, 0, cx, 0, 0, focal, cy, 0, 0, 0, 1, 0};
  c.P2 = c.P1;
  c.P2(0, 3) = -focal * baseline;
  c.Q = {1, 0, 0, -cx, 0, 1, 0, -cy, 0, 0, 0, focal, 0, 0, 1 / baseline, 0};
  return c;
}

void rectify(StereoCalibration& c) {
  CV_Assert(c.size.area() > 0);
  cv::Mat R1, R2, P1, P2, Q;
  cv::stereoRectify(c.M1, c.D1, c.M2, c.D2, c.size, c.R, c.T, R1, R2, P1, P2, Q,
                    cv::CALIB_ZERO_DISPARITY, 0, c.size);
  c.R1 = R1;
  c.R2 = R2;
  c.P1 = P1;
  c.P2 = P2;
  c.Q = Q;
}

Eigen::Matrix3d StereoCalibration::R_left_right() const {
  // OpenCV is row-major, Eigen column-major: this transposes R.
  return Eigen::Map<const Eigen::Matrix3d>(R.val);
}

void turn(StereoCalibration& c, const Eigen::Matrix3d& R_left_right) {
  constexpr double kSame = 1e-9;
  const cv::Matx33d R(R_left_right.data());
  if (cv::norm(R, c.R, cv::NORM_INF) < kSame) return;
  const cv::Vec3d right = -(c.R.t() * c.T);  // its centre, in the left camera's frame
  c.R = R;
  c.T = -(R * right);
  rectify(c);
}

cv::Vec2d ray_of(const StereoCalibration& c, Eye eye, cv::Point2d pixel) {
  std::vector<cv::Point2d> at = {pixel};
  const bool is_left = eye == Eye::Left;
  cv::undistortPoints(at, at, is_left ? c.M1 : c.M2, is_left ? c.D1 : c.D2);
  return {at[0].x, at[0].y};
}

std::optional<BoardView> find_board(const cv::Mat& left, const cv::Mat& right, const Board& board) {
  BoardView view;
  if (!find_corners(left, board, view.left) || !find_corners(right, board, view.right))
    return std::nullopt;
  // Detection may start at either end of a board; make it the same one in both images.
  const cv::Point2f along_left = view.left.back() - view.left.front();
  const cv::Point2f along_right = view.right.back() - view.right.front();
  if (along_left.dot(along_right) < 0) std::reverse(view.right.begin(), view.right.end());
  return view;
}

double difference(const BoardView& a, const BoardView& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.left.size(); ++i)
    sum += cv::norm(a.left[i] - b.left[i]) + cv::norm(a.right[i] - b.right[i]);
  return sum / static_cast<double>(2 * a.left.size());
}

Result<Calibrated> calibrate(std::span<const BoardView> views, const Board& board, cv::Size size) {
  if (board.columns < 3 || board.rows < 3 || board.columns == board.rows || !(board.square > 0))
    return Error{Code::Invalid,
                 "board: columns and rows must differ and be at least 3, square above 0"};
  if (views.size() < kLeastViews)
    return Error{Code::NotFound, std::to_string(views.size()) + " views of the board, at least " +
                                     std::to_string(kLeastViews) + " are needed"};
  Points points;
  for (const auto& view : views) {
    points.object.push_back(object_points(board));
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

std::array<double, 6> Calibrated::numbers() const {
  return {calibration.rms,           rms_left, rms_right, epipolar, calibration.baseline(),
          static_cast<double>(views)};
}

std::string Calibrated::text() const {
  return hc::format(
      "rms {:.3f} px (left {:.3f}, right {:.3f}), rows differ by {:.3f} px, baseline {:.4f} m, "
      "{} of {} views",
      calibration.rms, rms_left, rms_right, epipolar, calibration.baseline(), views, given);
}

}  // namespace hc::vision
