// SPDX-License-Identifier: Apache-2.0
#include <people/warp.h>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace {

using hc::people::warped;

constexpr int kSide = 100;

/// Grains, black outside of the middle of a strip.
cv::Mat strip(int length, bool is_upright) {
  cv::Mat grains(400, 400, CV_8UC1);
  cv::RNG(3).fill(grains, cv::RNG::UNIFORM, 0, 255);
  cv::Mat image = cv::Mat::zeros(400, length, CV_8UC1);
  grains.copyTo(image.colRange((length - 400) / 2, (length + 400) / 2));
  return is_upright ? cv::Mat(image.t()) : image;
}

cv::Matx23d turned(double turn, double scale, const cv::Point2d& to) {
  const double a = scale * std::cos(turn), b = scale * std::sin(turn);
  return {a, -b, to.x, b, a, to.y};
}

TEST(Warp, of_a_large_image_is_that_of_a_small_one) {
  constexpr int kLarge = 70000, kSmall = 20000;
  for (const bool is_upright : {false, true}) {
    const cv::Mat large = strip(kLarge, is_upright), small = strip(kSmall, is_upright);
    for (const double turn : {0.0, 0.7, 2.0, 4.0})
      for (const double scale : {0.25, 1.0, 3.0})
        for (const int border : {cv::BORDER_CONSTANT, cv::BORDER_REPLICATE}) {
          const double middle = kSmall / 2.0, offset = (kLarge - kSmall) / 2.0;
          cv::Point2d to(middle + 20, 180), far(to.x + offset, to.y);
          if (is_upright) {
            std::swap(to.x, to.y);
            std::swap(far.x, far.y);
          }
          const auto expected = warped(small, turned(turn, scale, to), kSide, border);
          const auto found = warped(large, turned(turn, scale, far), kSide, border);
          EXPECT_LE(cv::norm(found, expected, cv::NORM_INF), 1) << turn << ' ' << scale;
          EXPECT_GT(cv::mean(found)[0], 5) << "it shows grains";
        }
  }
}

TEST(Warp, of_all_of_a_large_image_shows_all_of_it) {
  const cv::Mat image = strip(70000, false);
  const cv::Mat found = warped(image, turned(0, 700, {0, 0}), kSide, cv::BORDER_CONSTANT);
  EXPECT_EQ(found.size(), cv::Size(kSide, kSide));
  EXPECT_GT(cv::countNonZero(found.row(0)), 0);
}

TEST(Warp, beside_an_image_is_its_border) {
  const cv::Mat large(400, 70000, CV_8UC1, cv::Scalar(10));
  for (const double y : {-1e6, 1e6}) {
    const auto black = warped(large, turned(0, 700, {0, y}), kSide, cv::BORDER_CONSTANT);
    EXPECT_EQ(cv::norm(black, cv::NORM_INF), 0) << y;
  }
  for (const int length : {400, 70000}) {
    const cv::Mat image(400, length, CV_8UC3, cv::Scalar(10, 20, 30));
    for (const cv::Point2d& at : {cv::Point2d(-1e6, 50), {1e6, 50}, {50, -1e6}}) {
      const auto black = warped(image, turned(1, 1, at), kSide, cv::BORDER_CONSTANT);
      EXPECT_EQ(cv::norm(black, cv::NORM_INF), 0) << at;
      const auto border = warped(image, turned(1, 1, at), kSide, cv::BORDER_REPLICATE);
      EXPECT_EQ(border.at<cv::Vec3b>(50, 50), cv::Vec3b(10, 20, 30)) << at;
    }
  }
}

}  // namespace
