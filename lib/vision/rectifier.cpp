// SPDX-License-Identifier: Apache-2.0
#include <vision/rectifier.h>

#include <algorithm>

#include <hc/base/format.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace hc::vision {

Result<Rectifier> Rectifier::make(const StereoCalibration& calibration, Eye eye, cv::Size size) {
  const auto& c = calibration;
  if (c.size.area() > 0 && c.size != size)
    return Error{Code::Unsupported,
                 hc::format("an image of {} x {}, the calibration is for {} x {}", size.width,
                            size.height, c.size.width, c.size.height)};
  constexpr int kMostSide = 32766;  // limit of cv::remap()
  if (size.width < 1 || size.height < 1 || size.width > kMostSide || size.height > kMostSide)
    return Error{Code::TooLarge,
                 hc::format("an image of {} x {} cannot be rectified", size.width, size.height)};
  const bool is_left = eye == Eye::Left;
  const auto& M = is_left ? c.M1 : c.M2;
  const auto& D = is_left ? c.D1 : c.D2;
  const auto& R = is_left ? c.R1 : c.R2;
  const cv::Matx33d P = (is_left ? c.P1 : c.P2).get_minor<3, 3>(0, 0);
  Rectifier rectifier;
  rectifier.size_ = size;
  const bool is_straight = std::all_of(D.begin(), D.end(), [](double k) { return k == 0; });
  if (is_straight && R == cv::Matx33d::eye() && P == M) return rectifier;
  cv::initUndistortRectifyMap(M, D, R, P, size, CV_16SC2, rectifier.whole_, rectifier.part_);
  return rectifier;
}

void Rectifier::rectify(const cv::Mat& image, cv::Mat& rectified) const {
  CV_Assert(image.size() == size_);
  if (whole_.empty())
    image.copyTo(rectified);
  else
    cv::remap(image, rectified, whole_, part_, cv::INTER_LINEAR);
}

}  // namespace hc::vision
