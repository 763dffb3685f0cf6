// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo.h>

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace hc::vision {
namespace {

const cv::Mat& grey(const cv::Mat& image, cv::Mat& buffer) {
  if (image.channels() == 1) return image;
  cv::cvtColor(image, buffer, cv::COLOR_RGB2GRAY);
  return buffer;
}

}  // namespace

StereoMatcher::StereoMatcher(const StereoOptions& options) {
  // The smoothness penalties of OpenCV's own documentation, for one channel; the other values were
  // chosen on the Aloe pair.
  int area = options.block_size * options.block_size;
  constexpr int kLeast = 0, kLeftRightDifference = 1, kPreFilterCap = 63, kUniqueness = 10;
  constexpr int kSpeckleSize = 100, kSpeckleRange = 2;
  matcher_ = cv::StereoSGBM::create(kLeast, options.disparities, options.block_size, 8 * area,
                                    32 * area, kLeftRightDifference, kPreFilterCap, kUniqueness,
                                    kSpeckleSize, kSpeckleRange, cv::StereoSGBM::MODE_SGBM_3WAY);
}

void StereoMatcher::match(const cv::Mat& left, const cv::Mat& right, cv::Mat& disparity) {
  CV_Assert(takes(left.size()) && left.size() == right.size());
  matcher_->compute(grey(left, left_grey_), grey(right, right_grey_), sixteenths_);
  constexpr int kScale = cv::StereoMatcher::DISP_SCALE;
  sixteenths_.convertTo(disparity, CV_32F, 1.0 / kScale);
  cv::max(disparity, 0.0, disparity);  // unknown is -1 there, 0 here
}

void depth_of(const cv::Mat& disparity, const StereoGeometry& geometry, cv::Mat& depth) {
  depth.create(disparity.size(), CV_32F);
  auto product = static_cast<float>(geometry.focal * geometry.baseline);
  auto offset = static_cast<float>(geometry.offset);
  for (int y = 0; y < disparity.rows; ++y) {
    const auto* from = disparity.ptr<float>(y);
    auto* to = depth.ptr<float>(y);
    for (int x = 0; x < disparity.cols; ++x) to[x] = from[x] > 0 ? product / (from[x] + offset) : 0;
  }
}

StereoScore score(const cv::Mat& disparity, const cv::Mat& truth, double truth_scale,
                  double threshold) {
  CV_Assert(disparity.size() == truth.size() && disparity.type() == CV_32F &&
            truth.type() == CV_8U);
  StereoScore score;
  for (int y = 0; y < truth.rows; ++y) {
    for (int x = 0; x < truth.cols; ++x) {
      int level = truth.at<std::uint8_t>(y, x);
      if (level == 0) continue;
      ++score.truth;
      float found = disparity.at<float>(y, x);
      if (found <= 0)
        ++score.holes;
      else if (std::abs(found - level * truth_scale) > threshold)
        ++score.bad;
    }
  }
  return score;
}

}  // namespace hc::vision
