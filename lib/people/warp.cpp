// SPDX-License-Identifier: Apache-2.0
#include <people/warp.h>

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace hc::people {
namespace {

constexpr int kMostSide = 32766;  // of an image: limit of cv::warpAffine()

/// The pixels from the least to the greatest place along an axis, with those that interpolation
/// takes beside them; at least one of the image's.
cv::Range span_of(double a, double b, double offset, int side, int extent) {
  const double far = side - 1, least = offset + std::min(0.0, a * far) + std::min(0.0, b * far);
  const double most = offset + std::max(0.0, a * far) + std::max(0.0, b * far);
  const auto pixel = [&](double at) {
    return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(extent - 1)));
  };
  return {pixel(least - 1), pixel(most + 2) + 1};
}

}  // namespace

cv::Mat warped(const cv::Mat& image, cv::Matx23d to_image, int side, int border) {
  cv::Mat part = image;
  if (std::max(image.cols, image.rows) > kMostSide) {
    const auto across = span_of(to_image(0, 0), to_image(0, 1), to_image(0, 2), side, image.cols);
    const auto down = span_of(to_image(1, 0), to_image(1, 1), to_image(1, 2), side, image.rows);
    part = image(down, across);
    to_image(0, 2) -= across.start;
    to_image(1, 2) -= down.start;
    const double scale = kMostSide / static_cast<double>(std::max(part.cols, part.rows));
    if (scale < 1) {
      const auto thinned = [&](int length) { return std::max(1, cvRound(length * scale)); };
      cv::resize(part, part, {thinned(part.cols), thinned(part.rows)}, 0, 0, cv::INTER_NEAREST);
      to_image = to_image * scale;
    }
  }
  cv::Mat made;
  cv::warpAffine(part, made, to_image, {side, side}, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                 border);
  return made;
}

}  // namespace hc::people
