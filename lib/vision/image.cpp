// SPDX-License-Identifier: Apache-2.0
#include <vision/image.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace hc::vision {
namespace {

/// The percentile of the values at `share`.
float percentile(std::vector<float>& values, double share) {
  auto nth =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

}  // namespace

double fit_scale(const cv::Size& size, int width, int height) {
  return std::max(static_cast<double>(width) / size.width,
                  static_cast<double>(height) / size.height);
}

cv::Mat fit(const cv::Mat& image, int width, int height, bool smooth) {
  double scale = fit_scale(image.size(), width, height);
  if (scale == 0 || image.size() == cv::Size(width, height)) return image;
  cv::Size covering(std::max(width, static_cast<int>(std::lround(image.cols * scale))),
                    std::max(height, static_cast<int>(std::lround(image.rows * scale))));
  int method = !smooth ? cv::INTER_NEAREST : scale < 1 ? cv::INTER_AREA : cv::INTER_LINEAR;
  cv::Mat scaled;
  cv::resize(image, scaled, covering, 0, 0, method);
  cv::Size kept(width == 0 ? covering.width : width, height == 0 ? covering.height : height);
  return scaled(cv::Rect((covering.width - kept.width) / 2, (covering.height - kept.height) / 2,
                         kept.width, kept.height));
}

cv::Mat grey_of(const cv::Mat& image) {
  if (image.channels() == 1) return image;
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_RGB2GRAY);
  return grey;
}

Span span_of(const cv::Mat& values) {
  cv::Mat numbers;
  values.convertTo(numbers, CV_32F);
  std::vector<float> known;
  for (int y = 0; y < numbers.rows; ++y)
    for (int x = 0; x < numbers.cols; ++x)
      if (float value = numbers.at<float>(y, x); std::isfinite(value) && value != 0)
        known.push_back(value);
  if (known.empty()) return {};
  return {percentile(known, 0.02), percentile(known, 0.98)};
}

cv::Mat colour_coded(const cv::Mat& values, double least, double most) {
  cv::Mat numbers;
  values.convertTo(numbers, CV_32F);
  // Below this the colour map is nearly black, like unknown values; from here on it is blue.
  constexpr long kLowest = 28;
  double span = most > least ? most - least : 1;
  cv::Mat levels(numbers.size(), CV_8U), unknown(numbers.size(), CV_8U);
  for (int y = 0; y < numbers.rows; ++y) {
    for (int x = 0; x < numbers.cols; ++x) {
      float value = numbers.at<float>(y, x);
      bool is_known = std::isfinite(value) && value != 0;
      unknown.at<std::uint8_t>(y, x) = is_known ? 0 : 255;
      double level = is_known ? std::clamp((value - least) / span, 0.0, 1.0) : 0;
      levels.at<std::uint8_t>(y, x) =
          static_cast<std::uint8_t>(kLowest + std::lround(level * (255 - kLowest)));
    }
  }
  cv::Mat coloured;
  cv::applyColorMap(levels, coloured, cv::COLORMAP_TURBO);
  cv::cvtColor(coloured, coloured, cv::COLOR_BGR2RGB);
  coloured.setTo(0, unknown);
  return coloured;
}

}  // namespace hc::vision
