// SPDX-License-Identifier: Apache-2.0
#include <people/image_changes.h>

#include <gtest/gtest.h>

#include <array>

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
  EXPECT_EQ(changes.in(kLeft), 0) << "one image has no changes";
  cv::Mat moved = noisy(chance);
  moved(cv::Rect(100, 300, 60, 90)) = cv::Scalar(200, 180, 160);
  changes.add(moved);
  EXPECT_GT(changes.in(kLeft), 1.3 * changes.in(kRight));
  changes.forget(kLeft);
  EXPECT_EQ(changes.in(kLeft), 0);
  EXPECT_GT(changes.in(kRight), 0);
}

TEST(ImageChanges, without_motion_are_a_matter_of_time) {
  cv::RNG chance(1);
  ImageChanges changes;
  std::array<int, 2> searched{};
  for (int i = 0; i < 40; ++i) {
    changes.add(noisy(chance));
    const bool is_left = changes.in(kLeft) > changes.in(kRight);
    changes.forget(is_left ? kLeft : kRight);
    ++searched[is_left ? 0 : 1];
  }
  EXPECT_NEAR(searched[0], 20, 2);
}

TEST(ImageChanges, of_other_images_begin_anew) {
  cv::RNG chance(1);
  ImageChanges changes;
  changes.add(noisy(chance));
  changes.add(noisy(chance));
  changes.add(cv::Mat(3, 5, CV_8UC1, cv::Scalar(7)));
  EXPECT_EQ(changes.in({0, 0, 5, 3}), 0);
  changes.add(cv::Mat(3, 5, CV_8UC1, cv::Scalar(9)));
  EXPECT_EQ(changes.in({0, 0, 5, 3}), 2);
  EXPECT_EQ(changes.in({-500, 40, 60, 60}), 0) << "outside";
}

}  // namespace
}  // namespace hc::people
