// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo/display.h>

#include <gtest/gtest.h>

#include <limits>
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

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(Coded, IsBlackWhereUnknown) {
  const cv::Mat values = (cv::Mat_<float>(1, 5) << 0, kNan, kInfinity, 1, 2);
  const cv::Mat image(1, 5, CV_8UC3, cv::Scalar(10, 20, 30));
  for (const auto coding : depth_codings()) {
    const cv::Mat bgr = coded(values, image, coding, {1, 2});
    for (int x = 0; x < 3; ++x) EXPECT_EQ(bgr.at<Vec3b>(0, x), Vec3b()) << coding << x;
    for (int x = 3; x < 5; ++x) EXPECT_NE(bgr.at<Vec3b>(0, x), Vec3b()) << coding << x;
    const cv::Mat nothing = coded(cv::Mat::zeros(1, 5, CV_32F), image, coding, {0, 0});
    EXPECT_EQ(cv::norm(nothing, cv::NORM_INF), 0) << coding;
  }
}

TEST(Coded, ReliefIsDarkWhereTheSurfaceTurnsFromTheLight) {
  cv::Mat values(3, 30, CV_32F);
  for (int x = 0; x < 30; ++x)
    values.col(x).setTo(x < 10 ? 1 : x < 20 ? 1 - 0.002 * (x - 10) : 0.98);
  values.at<float>(1, 25) = kNan;
  const cv::Mat flat = coded(values, {}, "colours", {0.9, 1.1});
  const cv::Mat relief = coded(values, {}, "relief", {0.9, 1.1});
  const auto is_darker = [&](int x) {
    return cv::sum(relief.at<Vec3b>(1, x))[0] < cv::sum(flat.at<Vec3b>(1, x))[0];
  };
  EXPECT_FALSE(is_darker(5));
  EXPECT_TRUE(is_darker(15)) << "comes nearer to the right";
  EXPECT_FALSE(is_darker(26)) << "beside an unknown value";
}

TEST(Coded, FogFadesTheImageByDistance) {
  const cv::Mat values = (cv::Mat_<float>(1, 4) << 0.5F, 1, 2, 9);
  const cv::Mat image(1, 4, CV_8UC3, cv::Scalar(25, 125, 225));
  const cv::Mat bgr = coded(values, image, "fog", {1, 3});
  EXPECT_EQ(bgr.at<Vec3b>(0, 0), Vec3b(25, 125, 225)) << "nearer than the scale";
  EXPECT_EQ(bgr.at<Vec3b>(0, 1), Vec3b(25, 125, 225));
  EXPECT_EQ(bgr.at<Vec3b>(0, 2), Vec3b(115, 170, 225)) << "0.45 of the way to the fog's grey, 225";
  EXPECT_EQ(bgr.at<Vec3b>(0, 3), Vec3b(205, 215, 225));
}

TEST(Legend, HasTheColoursOfTheScaleAndBlackForUnknown) {
  const cv::Mat image(300, 200, CV_8UC3, cv::Scalar(1, 2, 3));
  const cv::Mat whole = with_legend(image, "colours", {0.5, 4}, "m");
  ASSERT_EQ(whole.size(), cv::Size(200 + kLegendWidth, 300));
  EXPECT_EQ(whole.at<Vec3b>(150, 199), Vec3b(1, 2, 3));
  const Vec3b top = whole.at<Vec3b>(20, 225), low = whole.at<Vec3b>(235, 225);
  EXPECT_GT(top[2], top[0]) << "red on top";
  EXPECT_GT(low[0], low[2]) << "blue below";
  EXPECT_EQ(whole.at<Vec3b>(275, 225), Vec3b(0, 0, 0));
  const cv::Mat of_fog = with_legend(image, "fog", {0.5, 4}, "m");
  EXPECT_GT(of_fog.at<Vec3b>(20, 225)[0], 200) << "fog on top";
  EXPECT_LT(of_fog.at<Vec3b>(235, 225)[0], 60) << "and what is in it below";
  EXPECT_EQ(with_legend(image.rowRange(0, 100), "colours", {0, 1}, "").size(), cv::Size(200, 100));
}

}  // namespace
}  // namespace hc::vision
