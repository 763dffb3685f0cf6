// SPDX-License-Identifier: Apache-2.0
#include <vision/calibration.h>

#include <opencv2/calib3d.hpp>

namespace hc::vision {
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

}  // namespace hc::vision
