// SPDX-License-Identifier: Apache-2.0
#include "instruments.h"

#include <gtest/gtest.h>

namespace {

cv::Mat black() {
  return cv::Mat::zeros(120, 160, CV_8UC3);
}

TEST(Instruments, are_read_by_name) {
  const auto some = read_instruments("gaze, task");
  ASSERT_TRUE(some);
  EXPECT_TRUE(some->gaze && some->task && some->any());
  EXPECT_FALSE(some->depth || some->frames || some->confidence);
  EXPECT_FALSE(read_instruments("")->any());
  const auto wrong = read_instruments("gaze compass");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().detail.find("compass"), std::string::npos);
}

TEST(Instruments, axes_point_where_the_camera_sees_them) {
  const hc::graphics::PinholeCamera camera{160, 120, 100, 100, 80, 60, 0.05, 50};
  cv::Mat image = black();
  // x right, y down and z ahead: x and y are visible with 40 px.
  draw_axes(image, camera, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1)), "", 0.4);
  const auto at = [&](int x, int y) { return image.at<cv::Vec3b>(y, x); };
  EXPECT_GT(at(110, 60)[0], 150);
  EXPECT_LT(at(110, 60)[1], 100);
  EXPECT_GT(at(80, 90)[1], 150);
  EXPECT_EQ(at(130, 60), cv::Vec3b(0, 0, 0));
  image = black();
  draw_axes(image, camera, Eigen::Isometry3d(Eigen::Translation3d(0, 0, -1)), "behind");
  EXPECT_EQ(cv::norm(image), 0);
}

TEST(Instruments, what_is_beside_the_image_is_no_error) {
  cv::Mat image = black();
  draw_ring(image, {1e300, -1e300}, "far");
  draw_cross(image, {-500, 60}, "left");
  EXPECT_EQ(cv::norm(image), 0);
  draw_ring(image, {80, 60}, "");
  EXPECT_GT(image.at<cv::Vec3b>(60, 64)[0] + image.at<cv::Vec3b>(60, 96)[0], 150);
}

}  // namespace
