// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo/display.h>

#include <gtest/gtest.h>

#include <string>

namespace hc::vision {
namespace {

using cv::Vec3b;

TEST(JoinEyes, HasBothWhereTheLayoutSays) {
  const cv::Mat left(4, 6, CV_8UC3, cv::Scalar(10, 20, 30));
  const cv::Mat right(4, 6, CV_8UC3, cv::Scalar(90, 90, 90));
  const Vec3b of_left(10, 20, 30), of_right(90, 90, 90);
  cv::Mat joined = join_eyes(left, right, "side_by_side");
  EXPECT_EQ(joined.size(), cv::Size(12, 4));
  EXPECT_EQ(joined.at<Vec3b>(1, 5), of_left);
  EXPECT_EQ(joined.at<Vec3b>(1, 6), of_right);
  joined = join_eyes(left, right, "top_bottom");
  EXPECT_EQ(joined.size(), cv::Size(6, 8));
  EXPECT_EQ(joined.at<Vec3b>(3, 0), of_left);
  EXPECT_EQ(joined.at<Vec3b>(4, 0), of_right);
  joined = join_eyes(left, right, "rows");
  EXPECT_EQ(joined.at<Vec3b>(2, 3), of_left);
  EXPECT_EQ(joined.at<Vec3b>(3, 3), of_right);
  joined = join_eyes(left, right, "red_cyan");
  EXPECT_EQ(joined.at<Vec3b>(0, 0), Vec3b(90, 90, 22)) << "the left one's grey in red";
  EXPECT_EQ(join_eyes(left, right, "right").at<Vec3b>(0, 0), of_right);
}

TEST(JoinEyes, EachLayoutTakesGreyToo) {
  const cv::Mat grey(4, 6, CV_8U, cv::Scalar(50));
  for (const auto layout : stereo_layouts()) EXPECT_FALSE(join_eyes(grey, grey, layout).empty());
}

TEST(Shade, IsBrightWhereTheSurfaceTurnsToTheLight) {
  cv::Mat bgr(3, 30, CV_8UC3, cv::Scalar::all(100)), values(3, 30, CV_32F);
  for (int x = 0; x < 30; ++x)
    values.col(x).setTo(x < 10 ? 1 : x < 20 ? 1 - 0.002 * (x - 10) : 0.98);
  values.at<float>(1, 25) = 0;
  shade(bgr, values);
  EXPECT_EQ(bgr.at<Vec3b>(1, 5)[0], 100);
  EXPECT_LT(bgr.at<Vec3b>(1, 15)[0], 95) << "comes nearer to the right";
  EXPECT_EQ(bgr.at<Vec3b>(1, 25)[0], 100) << "unknown";
}

TEST(Legend, HasTheColoursOfTheScaleAndBlackForUnknown) {
  const cv::Mat image(300, 200, CV_8UC3, cv::Scalar(1, 2, 3));
  const cv::Mat whole = with_legend(image, 0.5, 4, "m");
  ASSERT_EQ(whole.size(), cv::Size(200 + kLegendWidth, 300));
  EXPECT_EQ(whole.at<Vec3b>(150, 199), Vec3b(1, 2, 3));
  const Vec3b top = whole.at<Vec3b>(20, 225), low = whole.at<Vec3b>(235, 225);
  EXPECT_GT(top[2], top[0]) << "red on top";
  EXPECT_GT(low[0], low[2]) << "blue below";
  EXPECT_EQ(whole.at<Vec3b>(275, 225), Vec3b(0, 0, 0));
  EXPECT_EQ(with_legend(image.rowRange(0, 100), 0, 1, "").size(), cv::Size(200, 100));
}

}  // namespace
}  // namespace hc::vision
