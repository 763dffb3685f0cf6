// SPDX-License-Identifier: Apache-2.0
#include <people/image_changes.h>

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace hc::people {
namespace {

const cv::Rect kLeft(0, 0, 400, 600), kRight(400, 0, 400, 600);

/// A grey image with some noise.
cv::Mat noisy(cv::RNG& chance) {
  cv::Mat image(600, 800, CV_8UC3);
  chance.fill(image, cv::RNG::NORMAL, 120, 5);
  return image;
}

TEST(ImageChanges, are_where_something_moves) {
  cv::RNG chance(1);
  ImageChanges changes;
  changes.add(noisy(chance));
  EXPECT_EQ(changes.change(kLeft), 0) << "one image has no changes";
  cv::Mat moved = noisy(chance);
  moved(cv::Rect(100, 300, 60, 90)) = cv::Scalar(200, 180, 160);
  changes.add(moved);
  EXPECT_GT(changes.change(kLeft), 1.3 * changes.change(kRight));
  changes.forget_change(kLeft);
  EXPECT_EQ(changes.change(kLeft), 0);
  EXPECT_GT(changes.change(kRight), 0);
}

TEST(ImageChanges, tell_how_long_ago_a_part_was_reset) {
  ImageChanges changes;
  const cv::Mat image(600, 800, CV_8UC1, cv::Scalar(90));
  for (int i = 0; i < 5; ++i) changes.add(image);
  EXPECT_EQ(changes.age(kLeft), 4);
  changes.forget_age(kLeft);
  changes.add(image);
  EXPECT_EQ(changes.age(kLeft), 1);
  EXPECT_EQ(changes.age(kRight), 5);
  EXPECT_NEAR(changes.age({200, 0, 400, 600}), 3, 1e-6);
  EXPECT_EQ(changes.change(kRight), 0);
}

TEST(ImageChanges, of_another_size_start_again) {
  cv::RNG chance(1);
  ImageChanges changes;
  changes.add(noisy(chance));
  changes.add(noisy(chance));
  changes.add(cv::Mat(3, 5, CV_8UC1, cv::Scalar(7)));
  EXPECT_EQ(changes.change({0, 0, 5, 3}), 0);
  changes.add(cv::Mat(3, 5, CV_8UC1, cv::Scalar(9)));
  EXPECT_EQ(changes.change({0, 0, 5, 3}), 2);
  EXPECT_EQ(changes.change({-500, 40, 60, 60}), 0) << "outside";
  EXPECT_EQ(changes.age({-500, 40, 60, 60}), 0);
}

}  // namespace
}  // namespace hc::people
