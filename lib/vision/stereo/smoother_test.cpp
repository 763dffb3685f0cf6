// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo/smoother.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include <hc/testing/vectors.h>

namespace hc::vision {
namespace {

/// Scalar reference along one direction.
cv::Mat plain_mean(const cv::Mat& disparity, int dy, int dx) {
  cv::Mat mean = disparity.clone();
  for (int y = 0; y < disparity.rows; ++y)
    for (int x = 0; x < disparity.cols; ++x) {
      const int own = disparity.at<std::uint16_t>(y, x);
      if (own == 0) continue;
      int sum = 0, number = 0;
      for (int k = -Smoother::kReach; k <= Smoother::kReach; ++k) {
        const cv::Point at(x + k * dx, y + k * dy);
        if (!cv::Rect({0, 0}, disparity.size()).contains(at)) continue;
        const int other = disparity.at<std::uint16_t>(at);
        if (other == 0 || std::abs(other - own) > Smoother::kRange) continue;
        sum += other - own;
        ++number;
      }
      const int inverse = ((1 << 15) + number / 2) / number;
      const int change = number == 1 ? 0 : (sum * inverse + (1 << 14)) >> 15;
      mean.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(std::max(1, own + change));
    }
  return mean;
}

class SmootherOf : public TestOfVectors {};

TEST_P(SmootherOf, IsThePlainOneBitByBit) {
  cv::RNG rng(5);
  Smoother smoother;
  for (int i = 0; i < 60; ++i) {
    cv::Mat disparity(rng.uniform(1, 40), rng.uniform(1, 90), CV_16U), smooth;
    rng.fill(disparity, cv::RNG::UNIFORM, 0, rng.uniform(2, 700));
    disparity.setTo(0, disparity < 40);
    smoother.smooth(disparity, smooth);
    const cv::Mat expected = plain_mean(plain_mean(disparity, 0, 1), 1, 0);
    ASSERT_EQ(cv::norm(smooth, expected, cv::NORM_INF), 0) << disparity.size();
  }
}

INSTANTIATE_TEST_SUITE_P(Vectors, SmootherOf, each_kind_of_vectors(), name_of_vectors);

TEST(Smoother, KeepsEdgesAndHoles) {
  cv::Mat disparity(20, 40, CV_16U, cv::Scalar(640)), smooth;
  disparity(cv::Rect(20, 0, 20, 20)) = 1280;
  disparity(cv::Rect(5, 5, 3, 3)) = 0;
  Smoother().smooth(disparity, smooth);
  EXPECT_EQ(cv::norm(smooth, disparity, cv::NORM_INF), 0);
}

}  // namespace
}  // namespace hc::vision
