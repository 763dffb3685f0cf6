// SPDX-License-Identifier: Apache-2.0
#include <vision/image.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace hc::vision {
namespace {

TEST(Fit, CoversAndCuts) {
  cv::Mat image(1110, 1282, CV_8UC3, cv::Scalar(1, 2, 3));
  cv::Mat fitted = fit(image, 800, 600);
  EXPECT_EQ(fitted.size(), cv::Size(800, 600));
  EXPECT_EQ(fitted.at<cv::Vec3b>(300, 400), cv::Vec3b(1, 2, 3));
  EXPECT_NEAR(fit_scale(image.size(), 800, 600), 800.0 / 1282, 1e-12);
  EXPECT_EQ(fit(image, 0, 0).data, image.data);
  EXPECT_EQ(fit(image, 641, 0).size(), cv::Size(641, 555));
}

TEST(Fit, TheNearestPixelMixesNothing) {
  cv::Mat image(100, 100, CV_8U, cv::Scalar(0));
  image.colRange(50, 100).setTo(200);
  cv::Mat fitted = fit(image, 37, 37, false);
  for (int x = 0; x < 37; ++x) {
    int value = fitted.at<std::uint8_t>(5, x);
    EXPECT_TRUE(value == 0 || value == 200) << value;
  }
}

TEST(ColourCoded, GoesFromBlueToRedAndUnknownIsBlack) {
  cv::Mat values = (cv::Mat_<float>(1, 4) << 1, 2, 0, NAN);
  cv::Mat colours = colour_coded(values, 1, 2);
  auto least = colours.at<cv::Vec3b>(0, 0), most = colours.at<cv::Vec3b>(0, 1);
  EXPECT_GT(least[2], least[0]);  // blue over red
  EXPECT_GT(least[2], 150) << "far from the black of what is unknown";
  EXPECT_GT(most[0], most[2]);
  EXPECT_EQ(colours.at<cv::Vec3b>(0, 2), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(colours.at<cv::Vec3b>(0, 3), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(colour_coded(cv::Mat::zeros(2, 2, CV_32F), 0, 0).at<cv::Vec3b>(1, 1),
            cv::Vec3b(0, 0, 0));
}

TEST(SpanOf, IsThatOfTheKnownValues) {
  cv::Mat values = (cv::Mat_<float>(1, 5) << 0, 3, NAN, 1, 2);
  EXPECT_EQ(span_of(values).least, 1);
  EXPECT_EQ(span_of(values).most, 2) << "the 98th percentile of three";
  EXPECT_EQ(span_of(cv::Mat::zeros(2, 2, CV_8U)).most, 0);
}

}  // namespace
}  // namespace hc::vision
