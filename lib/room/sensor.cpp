// SPDX-License-Identifier: Apache-2.0
#include <room/sensor.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <opencv2/imgproc.hpp>

namespace hc::room {

namespace {

constexpr int kMargin = 128;  // [px]

}  // namespace

void Sensor::apply(cv::Mat& rgb, double blur, double noise, std::uint64_t number) {
  if (blur > 0) cv::GaussianBlur(rgb, rgb, {}, blur);
  if (noise <= 0) return;
  const cv::Size wanted(rgb.cols + kMargin, rgb.rows + kMargin);
  if (field_.size() != wanted || noise_ != noise) {
    cv::RNG random(seed_ * 2654435761U + 17);
    cv::Mat values(wanted, CV_16SC3);
    random.fill(values, cv::RNG::NORMAL, 0.0, noise);
    values.convertTo(field_, CV_8SC3);
    noise_ = noise;
  }
  cv::RNG place(seed_ ^ (number * 0x9e3779b97f4a7c15U + 1));
  const int x = place.uniform(0, kMargin), y = place.uniform(0, kMargin);
  const int count = 3 * rgb.cols;  // a local variable, so that the loop is vectorised
  for (int row = 0; row < rgb.rows; ++row) {
    auto* to = rgb.ptr<std::uint8_t>(row);
    const auto* from = field_.ptr<std::int8_t>(row + y) + std::ptrdiff_t{3} * x;
    for (int i = 0; i < count; ++i)
      to[i] = static_cast<std::uint8_t>(std::clamp(to[i] + from[i], 0, 255));
  }
}

}  // namespace hc::room
