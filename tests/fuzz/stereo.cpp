// SPDX-License-Identifier: Apache-2.0
// Any two images, of any sizes and types: a result of the left one's size whose disparities are
// within the search, or one clear error.

#include <cstdint>

#include <hc/base/check.h>
#include <vision/stereo/matcher.h>

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it so
int fuzz_stereo(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kHead = 6;
  if (size < kHead) return 0;
  constexpr int kTypes[] = {CV_8U, CV_8UC3, CV_16U, CV_8UC4, CV_32F};
  const auto image = [&](int width, int height, int type, std::size_t from) {
    cv::Mat made(height, width, type);
    for (int y = 0; y < made.rows; ++y)
      for (std::size_t x = 0; x < made.elemSize() * static_cast<std::size_t>(made.cols); ++x)
        made.ptr(y)[x] = data[(from + x + 31 * static_cast<std::size_t>(y)) % size];
    return made;
  };
  const int width = data[0], height = data[1] % 48;
  const int other_width = data[2] % 8 == 0 ? data[2] : width;
  const cv::Mat left = image(width, height, data[3] % 8 == 0 ? kTypes[data[3] / 8 % 5] : CV_8U, 0);
  const cv::Mat right =
      image(other_width, height, data[4] % 8 == 0 ? kTypes[data[4] / 8 % 5] : CV_8U, data[4]);
  const int disparities = 16 * (1 + data[5] % 16);
  const auto matcher = hc::vision::semi_global_matcher({.disparities = disparities});
  hc::vision::Disparities found;
  const auto status = matcher->match(left, right, found, hc::vision::Eyes::Both);
  if (!status) {
    HC_CHECK(!status.error().detail.empty(), width, height);
    return 0;
  }
  HC_CHECK(found.confidence.size() == left.size(), width);
  for (const cv::Mat* disparity : {&found.disparity, &found.right}) {
    double least = 0, most = 0;
    cv::minMaxLoc(*disparity, &least, &most);
    HC_CHECK(disparity->size() == left.size(), width);
    HC_CHECK(least >= 0 && most <= disparities, least, most);
  }
  return 0;
}
