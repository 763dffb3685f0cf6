// SPDX-License-Identifier: Apache-2.0
#include <nets/depthwise.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/core.hpp>

#include <hc/testing/vectors.h>

namespace hc::nets {
namespace {

using Options = PlaneConvolution::Options;

cv::Size size_of_result(const Options& options, const cv::Size& from) {
  const auto& window = options.window;
  return {(from.width + window.left + window.right - window.width) / options.stride_right + 1,
          (from.height + window.top + window.bottom - window.height) / options.stride_down + 1};
}

/// One number after another.
std::vector<float> plain(const Options& options, const cv::Size& from, const cv::Size& to,
                         const std::vector<float>& image, const std::vector<float>& weights,
                         float bias) {
  const auto& window = options.window;
  std::vector<float> result;
  for (int y = 0; y < to.height; ++y)
    for (int x = 0; x < to.width; ++x) {
      float sum = bias;
      for (int v = 0; v < window.height; ++v)
        for (int u = 0; u < window.width; ++u) {
          const cv::Point at(x * options.stride_right + u - window.left,
                             y * options.stride_down + v - window.top);
          const bool is_inside = cv::Rect({}, from).contains(at);
          const float pixel =
              is_inside ? image[static_cast<std::size_t>(at.y * from.width + at.x)] : 0;
          sum += weights[static_cast<std::size_t>(v * window.width + u)] * pixel;
        }
      result.push_back(std::clamp(sum, options.min, options.max));
    }
  return result;
}

class DepthwiseOf : public TestOfVectors {};

TEST_P(DepthwiseOf, is_the_plain_one_bit_by_bit) {
  cv::RNG rng(3);
  for (int i = 0; i < 300; ++i) {
    Options options;
    auto& window = options.window;
    window = {rng.uniform(1, 8), rng.uniform(1, 8), rng.uniform(0, 4),
              rng.uniform(0, 4), rng.uniform(0, 4), rng.uniform(0, 4)};
    options.stride_down = i % 20 == 0 ? 64 : rng.uniform(1, 5);
    options.stride_right = i % 20 == 1 ? 64 : rng.uniform(1, 5);
    if (i % 3 == 0) options.min = 0;
    if (i % 6 == 0) options.max = 6;
    const cv::Size least(std::max(1, window.width - window.left - window.right),
                         std::max(1, window.height - window.top - window.bottom));
    const cv::Size from = least + cv::Size(rng.uniform(0, 60), i % 5 == 0 ? 0 : rng.uniform(0, 40));
    const cv::Size to = size_of_result(options, from);
    std::vector<float> image(static_cast<std::size_t>(from.area())),
        weights(static_cast<std::size_t>(window.height * window.width)),
        found(static_cast<std::size_t>(to.area()));
    rng.fill(image, cv::RNG::UNIFORM, -2, 2);
    rng.fill(weights, cv::RNG::UNIFORM, -1, 1);
    PlaneConvolution plane(options, from, to);
    for (int channel = 0; channel < 2; ++channel) {  // the second finds the first one's memory
      std::reverse(image.begin(), image.end());
      plane.convolve(image.data(), weights, 0.25F, found.data());
    }
    ASSERT_EQ(found, plain(options, from, to, image, weights, 0.25F))
        << window.height << 'x' << window.width << " of " << from;
  }
}

TEST_P(DepthwiseOf, keeps_what_is_not_a_number) {
  Options options;
  options.min = 0;
  options.max = 6;
  const float from = NAN, weight = 1;
  float found = 0;
  PlaneConvolution(options, {1, 1}, {1, 1}).convolve(&from, {&weight, 1}, 0, &found);
  EXPECT_TRUE(std::isnan(found));
}

INSTANTIATE_TEST_SUITE_P(Vectors, DepthwiseOf, each_kind_of_vectors(), name_of_vectors);

}  // namespace
}  // namespace hc::nets
