// SPDX-License-Identifier: Apache-2.0
#include <nets/pointwise.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

#include <hc/testing/vectors.h>

namespace hc::nets {
namespace {

class PointwiseOf : public TestOfVectors {};

TEST_P(PointwiseOf, is_the_plain_one_bit_by_bit) {
  cv::RNG rng(3);
  for (int i = 0; i < 300; ++i) {
    const int in = i % 20 == 0 ? 1 : rng.uniform(1, 70), out = rng.uniform(1, 20);
    const auto size = static_cast<std::size_t>(i % 20 == 1 ? 1 : rng.uniform(1, 200));
    cv::Mat weights(out, in, CV_32F), from(in, static_cast<int>(size), CV_32F),
        addend(out, from.cols, CV_32F), found(out + 1, from.cols, CV_32F, cv::Scalar(NAN));
    rng.fill(weights, cv::RNG::UNIFORM, -1, 1);
    rng.fill(from, cv::RNG::UNIFORM, -2, 2);
    rng.fill(addend, cv::RNG::UNIFORM, -2, 2);
    std::vector<float> bias(static_cast<std::size_t>(out));
    rng.fill(bias, cv::RNG::UNIFORM, -1, 1);
    PointwiseConvolution::Activation activation{std::vector<float>(bias.size(), 1)};
    if (i % 3 == 0) rng.fill(activation.slopes, cv::RNG::UNIFORM, 0, 1);
    if (i % 3 == 1) activation.max = 1;
    const bool is_added = i % 2 == 0;

    const PointwiseConvolution convolution(weights, bias, activation);
    // In two parts, as two threads compute it; the rest is as it was.
    const int half = from.cols / 2;
    for (const cv::Range& part : {cv::Range(half, from.cols), cv::Range(0, half)}) {
      const cv::Mat before = found.clone();
      convolution.convolve(
          {from.ptr<float>(), is_added ? addend.ptr<float>() : nullptr, found.ptr<float>(), size},
          static_cast<std::size_t>(part.start), static_cast<std::size_t>(part.end));
      for (int y = 0; y <= out; ++y)
        for (int x = 0; x < found.cols; ++x) {
          if (y < out && part.start <= x && x < part.end) continue;
          const float now = found.at<float>(y, x), then = before.at<float>(y, x);
          ASSERT_TRUE(now == then || (std::isnan(now) && std::isnan(then))) << y << ' ' << x;
        }
    }

    for (int y = 0; y < out; ++y)
      for (int x = 0; x < found.cols; ++x) {
        const auto channel = static_cast<std::size_t>(y);
        float sum = bias[channel];
        for (int k = 0; k < in; ++k) sum += weights.at<float>(y, k) * from.at<float>(k, x);
        if (is_added) sum += addend.at<float>(y, x);
        sum = sum < 0 ? sum * activation.slopes[channel] : std::min(sum, activation.max);
        ASSERT_EQ(found.at<float>(y, x), sum) << in << " to " << out << " channels, pixel " << x;
      }
  }
}

TEST_P(PointwiseOf, keeps_what_is_not_a_number) {
  const cv::Mat weights(1, 1, CV_32F, cv::Scalar(1));
  const float from = NAN;
  for (const float slope : {0.F, 1.F}) {
    float found = 0;
    PointwiseConvolution(weights, {0}, {{slope}, 6}).convolve({&from, nullptr, &found, 1}, 0, 1);
    EXPECT_TRUE(std::isnan(found)) << slope;
  }
}

INSTANTIATE_TEST_SUITE_P(Vectors, PointwiseOf, each_kind_of_vectors(), name_of_vectors);

}  // namespace
}  // namespace hc::nets
