// SPDX-License-Identifier: Apache-2.0
#include "search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace {

using hc::vision::BlobColour;

const cv::Scalar kRed(200, 20, 20), kGreen(20, 190, 20), kDarkRed(40, 4, 4);
const BlobColour kSetRed;
constexpr double kMinArea = 60;  // [px²]

/// A disc of a colour on a grey wall, at (40, 30), 160 by 120 pixels.
cv::Mat disc(const cv::Scalar& rgb) {
  cv::Mat image(120, 160, CV_8UC3, cv::Scalar(90, 95, 90));
  cv::circle(image, {40, 30}, 10, rgb, cv::FILLED);
  return image;
}

class SearchTest : public testing::Test {
 protected:
  bool is_found(const cv::Scalar& rgb, const BlobColour& set = kSetRed) {
    return search_.look(disc(rgb), set, kMinArea).has_value();
  }

  std::vector<std::string> said_;
  Search search_{[this](std::string_view line) { said_.emplace_back(line); }};
};

TEST_F(SearchTest, is_for_the_colour_that_is_set) {
  EXPECT_TRUE(is_found(kRed));
  EXPECT_FALSE(is_found(kGreen));
  EXPECT_TRUE(is_found(kGreen, {.hue = 0.33}));
  EXPECT_TRUE(said_.empty());
}

TEST_F(SearchTest, is_for_the_colour_that_was_pointed_at_until_the_hue_is_set) {
  search_.point(42, 28);
  EXPECT_TRUE(is_found(kGreen)) << "in the next image";
  EXPECT_FALSE(is_found(kRed));
  EXPECT_TRUE(is_found(kGreen, {.min_value = 0.9})) << "other parameters do not change it";
  ASSERT_EQ(said_.size(), 1U);
  EXPECT_TRUE(said_[0].starts_with("point: hue 0.333, saturation ")) << said_[0];
  EXPECT_FALSE(is_found(kGreen, {.hue = 0.01}));
  EXPECT_FALSE(is_found(kGreen)) << "it is over";
}

TEST_F(SearchTest, what_has_no_colour_or_no_place_is_not_taken) {
  search_.point(150, 100);
  EXPECT_TRUE(is_found(kRed));
  search_.point(160, 30);
  EXPECT_TRUE(is_found(kRed));
  search_.point(NAN, 30);
  search_.point(30, -1e300);
  EXPECT_TRUE(is_found(kRed));
  EXPECT_EQ(said_,
            (std::vector<std::string>{"point: no colour at 150, 100", "point: outside the image",
                                      "point: outside the image", "point: outside the image"}));
}

TEST_F(SearchTest, says_once_what_is_too_dark) {
  for (int i = 0; i < 39; ++i) EXPECT_FALSE(is_found(kDarkRed));
  EXPECT_TRUE(said_.empty());
  for (int i = 0; i < 60; ++i) EXPECT_FALSE(is_found(kDarkRed));
  ASSERT_EQ(said_.size(), 1U);
  EXPECT_TRUE(said_[0].starts_with("no blob in 40 images: pixels of hue 0.00 have a ")) << said_[0];
}

TEST_F(SearchTest, says_nothing_where_one_was_found_or_nothing_is_of_the_hue) {
  EXPECT_TRUE(is_found(kRed));
  for (int i = 0; i < 60; ++i) EXPECT_FALSE(is_found(kDarkRed));
  Search other{[this](std::string_view line) { said_.emplace_back(line); }};
  for (int i = 0; i < 60; ++i) EXPECT_FALSE(other.look(disc(kGreen), kSetRed, kMinArea));
  EXPECT_TRUE(said_.empty());
}

TEST_F(SearchTest, is_summed_up_when_it_was_long) {
  for (int i = 0; i < 20; ++i) is_found(i < 3 ? kRed : kGreen);
  EXPECT_EQ(search_.summary(), "");
  is_found(kRed);
  EXPECT_EQ(search_.summary(), "saw its target in 4 of 21 images");
}

}  // namespace
