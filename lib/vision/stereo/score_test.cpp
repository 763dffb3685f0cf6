// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo/score.h>

#include <gtest/gtest.h>

namespace hc::vision {
namespace {

TEST(Score, CountsHolesApart) {
  cv::Mat disparity = (cv::Mat_<float>(1, 5) << 0, 10, 13, 9, 50);
  cv::Mat truth = (cv::Mat_<float>(1, 5) << 2.5, 10, 10, 10, 0);
  auto counted = score(disparity, truth, 2);
  EXPECT_EQ(counted.truth, 4);
  EXPECT_EQ(counted.holes, 1);
  EXPECT_EQ(counted.bad, 1);
  EXPECT_DOUBLE_EQ(counted.bad_share(), 1.0 / 3);
  EXPECT_DOUBLE_EQ(counted.hole_share(), 0.25);
  EXPECT_DOUBLE_EQ(counted.wrong_share(), 0.5);
  EXPECT_EQ(StereoScore().bad_share(), 0);
}

}  // namespace
}  // namespace hc::vision
