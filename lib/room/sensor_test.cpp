// SPDX-License-Identifier: Apache-2.0
#include <room/sensor.h>

#include <gtest/gtest.h>

namespace hc::room {

namespace {

TEST(Sensor, adds_noise_of_the_deviation_asked_for) {
  for (double noise : {2.0, 20.0}) {
    cv::Mat image(300, 400, CV_8UC3, cv::Scalar::all(128));
    Sensor(1).apply(image, 0, noise, 5);
    cv::Scalar mean, deviation;
    cv::meanStdDev(image, mean, deviation);
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(mean[channel], 128, 0.3);
      EXPECT_NEAR(deviation[channel], noise, 0.05 * noise + 0.1);  // values are rounded
    }
  }
}

TEST(Sensor, gives_the_same_noise_for_a_number_and_another_for_the_next) {
  auto noisy = [](std::uint64_t seed, std::uint64_t number) {
    cv::Mat image(60, 80, CV_8UC3, cv::Scalar::all(128));
    Sensor(seed).apply(image, 0, 5, number);
    return image;
  };
  EXPECT_EQ(cv::norm(noisy(1, 3), noisy(1, 3), cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(noisy(1, 3), noisy(1, 4), cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(noisy(1, 3), noisy(2, 3), cv::NORM_INF), 0);
}

TEST(Sensor, blurs_an_edge_and_leaves_an_image_alone_when_told_nothing) {
  cv::Mat image(20, 20, CV_8UC3, cv::Scalar::all(0));
  image.colRange(10, 20) = cv::Scalar::all(200);
  const cv::Mat before = image.clone();
  Sensor(1).apply(image, 0, 0, 1);
  EXPECT_EQ(cv::norm(before, image, cv::NORM_INF), 0);
  Sensor(1).apply(image, 2, 0, 1);
  EXPECT_GT(image.at<cv::Vec3b>(10, 8)[0], 10);
  EXPECT_LT(image.at<cv::Vec3b>(10, 11)[0], 190);
}

}  // namespace

}  // namespace hc::room
