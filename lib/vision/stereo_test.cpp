// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include <vision/image.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace hc::vision {
namespace {

std::string data(const char* name) {
  const char* folder = std::getenv("HC_DATA");
  return std::string(folder == nullptr ? "/usr/share/doc/opencv-doc/examples/data" : folder) + "/" +
         name;
}

TEST(Stereo, FindsAShiftThatIsPutIn) {
  cv::Mat left(120, 320, CV_8U), right;
  cv::theRNG().state = 5;
  cv::randu(left, 0, 255);
  cv::GaussianBlur(left, left, {3, 3}, 0);
  constexpr int kShift = 12;
  cv::Mat shift = (cv::Mat_<double>(2, 3) << 1, 0, -kShift, 0, 1, 0);
  cv::warpAffine(left, right, shift, left.size());
  cv::Mat disparity;
  StereoMatcher({.disparities = 64}).match(left, right, disparity);
  cv::Mat middle = disparity(cv::Rect(80, 20, 200, 80));
  EXPECT_NEAR(cv::mean(middle)[0], kShift, 0.1) << "px";
}

TEST(Stereo, DepthIsFocalTimesBaselineByDisparity) {
  cv::Mat disparity = (cv::Mat_<float>(1, 3) << 0, 10, 40), depth;
  depth_of(disparity, {.focal = 800, .baseline = 0.1, .offset = 0}, depth);
  EXPECT_EQ(depth.at<float>(0, 0), 0);
  EXPECT_FLOAT_EQ(depth.at<float>(0, 1), 8);
  EXPECT_FLOAT_EQ(depth.at<float>(0, 2), 2);
  depth_of(disparity, {.focal = 800, .baseline = 0.1, .offset = 40}, depth);
  EXPECT_FLOAT_EQ(depth.at<float>(0, 2), 1);
}

TEST(Score, CountsHolesApart) {
  cv::Mat disparity = (cv::Mat_<float>(1, 5) << 0, 10, 13, 9, 50);
  cv::Mat truth = (cv::Mat_<std::uint8_t>(1, 5) << 5, 20, 20, 20, 0);
  auto counted = score(disparity, truth, 0.5, 2);
  EXPECT_EQ(counted.truth, 4);
  EXPECT_EQ(counted.holes, 1);
  EXPECT_EQ(counted.bad, 1);
  EXPECT_DOUBLE_EQ(counted.bad_share(), 1.0 / 3);
  EXPECT_DOUBLE_EQ(counted.hole_share(), 0.25);
  EXPECT_DOUBLE_EQ(counted.wrong_share(), 0.5);
  EXPECT_EQ(StereoScore().bad_share(), 0);
}

// Aloe as graphs/depth.toml has it; the whole graph must come to the same figures (tests/pipes).
TEST(Stereo, AloeIsAsGoodAsOpenCvIsKnownToBe) {
  cv::Mat left = fit(cv::imread(data("aloeL.jpg")), 800, 600);
  cv::Mat right = fit(cv::imread(data("aloeR.jpg")), 800, 600);
  cv::Mat truth = fit(cv::imread(data("aloeGT.png"), cv::IMREAD_GRAYSCALE), 800, 600, false);
  ASSERT_FALSE(left.empty() || right.empty() || truth.empty());
  cv::cvtColor(left, left, cv::COLOR_BGR2RGB);
  cv::cvtColor(right, right, cv::COLOR_BGR2RGB);
  cv::Mat disparity;
  StereoMatcher({.disparities = 128}).match(left, right, disparity);
  auto counted = score(disparity, truth, 800.0 / 1282, 2);
  EXPECT_NEAR(100 * counted.bad_share(), 2.7, 0.2) << "% of valid pixels, error over 2 px";
}

}  // namespace
}  // namespace hc::vision
