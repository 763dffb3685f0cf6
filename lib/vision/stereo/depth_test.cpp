// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo/depth.h>

#include <gtest/gtest.h>

#include <cmath>

namespace hc::vision {
namespace {

TEST(Depth, IsFocalTimesBaselineByDisparity) {
  cv::Mat disparity = (cv::Mat_<float>(1, 3) << 0, 10, 40), depth;
  depth_of(disparity, {.focal = 800, .baseline = 0.1, .offset = 0}, depth);
  EXPECT_EQ(depth.at<float>(0, 0), 0);
  EXPECT_FLOAT_EQ(depth.at<float>(0, 1), 8);
  EXPECT_FLOAT_EQ(depth.at<float>(0, 2), 2);
  depth_of(disparity, {.focal = 800, .baseline = 0.1, .offset = 40}, depth);
  EXPECT_FLOAT_EQ(depth.at<float>(0, 2), 1);
}

TEST(Points, LieWhereThePixelLooks) {
  const cv::Mat depth = (cv::Mat_<float>(2, 2) << 0, 2, 4, 0.5F);
  const cv::Mat image(2, 2, CV_8UC3, cv::Scalar(255, 51, 0));
  cv::Mat points;
  points_of(depth, image, {.focal = 10, .cx = 0, .cy = 1}, points);
  using Point = cv::Vec<float, 6>;
  EXPECT_TRUE(std::isnan(points.at<Point>(0, 0)[2])) << "the depth is unknown";
  EXPECT_EQ(points.at<Point>(0, 1), Point(0.2F, -0.2F, 2, 1, 0.2F, 0));
  EXPECT_EQ(points.at<Point>(1, 0), Point(0, 0, 4, 1, 0.2F, 0));
}

}  // namespace
}  // namespace hc::vision
