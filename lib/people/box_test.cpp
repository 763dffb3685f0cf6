// SPDX-License-Identifier: Apache-2.0
#include <people/box.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using hc::people::parts_of;

constexpr double kOverlap = 0.23;  // of a part: nearly a quarter

/// That parts of a shape cover an image and overlap, in order.
void expect_cover(const cv::Size& image, const cv::Size& shape) {
  const auto parts = parts_of(image, shape);
  const bool is_wide = image.width * shape.height > image.height * shape.width;
  const auto begin = [&](const cv::Rect& part) { return is_wide ? part.x : part.y; };
  const auto end = [&](const cv::Rect& part) { return is_wide ? part.br().x : part.br().y; };
  ASSERT_FALSE(parts.empty());
  EXPECT_EQ(begin(parts.front()), 0) << image;
  EXPECT_EQ(end(parts.back()), is_wide ? image.width : image.height) << image;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const cv::Rect& part = parts[i];
    EXPECT_EQ(is_wide ? part.y : part.x, 0);
    EXPECT_GE(is_wide ? part.height : part.width, is_wide ? image.height : image.width);
    const double side = end(part) - begin(part);
    if (i > 0) EXPECT_GE(end(parts[i - 1]) - begin(part), kOverlap * side) << image << ' ' << i;
    if (parts.size() > 1)
      EXPECT_NEAR(1.0 * part.width * shape.height, 1.0 * part.height * shape.width,
                  shape.width + shape.height)
          << image;
  }
}

TEST(Parts, cover_images_of_any_size) {
  for (const cv::Size shape : {cv::Size(1, 1), {256, 192}, {3, 4}})
    for (const cv::Size image : {cv::Size(800, 600),
                                 {600, 800},
                                 {1280, 720},
                                 {720, 1280},
                                 {711, 533},
                                 {97, 400},
                                 {40, 30},
                                 {65535, 40},
                                 {40, 65535},
                                 {1, 600},
                                 {800, 1}})
      expect_cover(image, shape);
}

TEST(Parts, are_the_whole_image_if_it_has_nearly_their_shape) {
  for (const cv::Size image : {cv::Size(800, 600), {640, 480}, {1366, 1024}, {606, 450}})
    EXPECT_EQ(parts_of(image, {256, 192}), std::vector{cv::Rect({}, image)}) << image;
  EXPECT_EQ(parts_of({800, 600}), (std::vector<cv::Rect>{{0, 0, 600, 600}, {200, 0, 600, 600}}));
}

TEST(Parts, of_an_empty_image_are_empty) {
  EXPECT_EQ(parts_of({0, 0}), std::vector{cv::Rect()});
}

TEST(Parts, are_few_for_a_strip) {
  for (const cv::Size image : {cv::Size(65535, 40), {40, 65535}, {1, 600}, {800, 1}})
    EXPECT_LE(parts_of(image, {256, 192}).size(), 12U) << image;
}

}  // namespace
