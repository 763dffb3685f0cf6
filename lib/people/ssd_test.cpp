// SPDX-License-Identifier: Apache-2.0
#include <people/ssd.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <people/made_network_test.h>

namespace hc::people {
namespace {

struct Thing {
  cv::Rect2f box;
  float score = 0;
  std::array<cv::Point2f, 1> points;
};

TEST(Ssd, boxes_that_overlap_are_merged_into_their_weighted_mean) {
  const auto kept = merged<Thing>({{{0, 0, 10, 10}, 0.5F, {{{1, 1}}}},
                                   {{100, 0, 10, 10}, 0.6F, {{{101, 1}}}},
                                   {{2, 0, 10, 10}, 1, {{{4, 1}}}}});
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[0].score, 1) << "best first";
  EXPECT_NEAR(kept[0].box.x, 4 / 3.0, 1e-5);
  EXPECT_NEAR(kept[0].box.width, 10, 1e-5);
  EXPECT_NEAR(kept[0].points[0].x, 3, 1e-5);
  EXPECT_NEAR(kept[1].box.x, 100, 1e-4);
}

TEST(Ssd, empty_boxes_are_kept_apart) {
  EXPECT_TRUE(merged<Thing>({}).empty());
  EXPECT_TRUE(merged<Thing>({{{}, 0.9F, {}}, {{}, 0.8F, {}}}).empty());
}

TEST(Ssd, numbers_that_are_no_places_are_no_detections) {
  cv::Mat numbers = cv::Mat::zeros(2, 6, CV_32F), scores = cv::Mat::ones(2, 1, CV_32F);
  numbers.col(2) = 2;
  numbers.col(3) = 2;
  auto ssd =
      Ssd::make(std::make_unique<MadeNetwork>(nets::Shape{4, 4, 3}, std::vector{numbers, scores}),
                {{4, 2}}, 1, {}, "things");
  ASSERT_TRUE(ssd);
  const cv::Mat image(40, 40, CV_8UC3, cv::Scalar::all(90));
  const auto found = [&] { return ssd->find<Thing>(image, {0, 0, 40, 40}, 0.5F).size(); };
  EXPECT_EQ(found(), 2U);
  for (const float wrong : {NAN, INFINITY, -INFINITY, 1e30F, 9.F})
    for (int i = 0; i < numbers.cols; ++i) {
      const float right = std::exchange(numbers.at<float>(1, i), wrong);
      EXPECT_EQ(found(), 1U) << wrong << " in column " << i;
      numbers.at<float>(1, i) = right;
    }
  scores.at<float>(1) = NAN;
  EXPECT_EQ(found(), 1U);
  scores.at<float>(1) = -INFINITY;
  EXPECT_EQ(found(), 1U);
}

TEST(Ssd, a_part_of_any_size_and_place_is_seen_where_it_is) {
  cv::Mat numbers = cv::Mat::zeros(24, 6, CV_32F), scores(24, 1, CV_32F, cv::Scalar(-100));
  scores.at<float>(0) = 100;
  auto made = std::make_unique<MadeNetwork>(nets::Shape{192, 256, 3}, std::vector{numbers, scores});
  const MadeNetwork& network = *made;
  auto ssd = Ssd::make(std::move(made), {{64, 2}}, 1, {}, "things");
  ASSERT_TRUE(ssd);
  for (const int type : {CV_8UC3, CV_8UC1})
    for (const int height : {30, 101, 199, 275, 281, 334, 600})
      for (int width = 30; width < 800; width += 7) {
        const cv::Rect part(width / 3 - 10, height / 5 - 5, width, height);
        const int side = std::min(width, height) / 4;
        const cv::Rect square(part.x + part.width / 2, part.y + part.height / 2, side, side);
        cv::Mat image(600, 800, type, cv::Scalar::all(0));
        image(square) = cv::Scalar::all(255);
        const auto found = ssd->find<Thing>(image, part, 0.5F);
        ASSERT_EQ(found.size(), 1U);
        // The first anchor is at (32, 32). It says where the white square is, in the network's
        // image.
        cv::Mat red;
        cv::extractChannel(network.last(), red, 0);
        const auto sums = cv::moments(red);
        const cv::Point2d seen(sums.m10 / sums.m00 + 0.5, sums.m01 / sums.m00 + 0.5);
        const double scale = std::max(width / 256.0, height / 192.0);
        const cv::Point2d anchor = (found[0].box.tl() + found[0].box.br()) / 2;
        const cv::Point2d place = anchor + (seen - cv::Point2d(32, 32)) * scale;
        EXPECT_LT(cv::norm(place - cv::Point2d(square.tl() + square.br()) / 2),
                  0.75 * std::max(1.0, scale))
            << part;
      }
}

TEST(Ssd, a_strip_takes_no_more_memory_than_it_has) {
  auto ssd = Ssd::make(std::make_unique<MadeNetwork>(
                           nets::Shape{4, 4, 3}, std::vector{cv::Mat(cv::Mat::zeros(2, 6, CV_32F)),
                                                             cv::Mat(cv::Mat::ones(2, 1, CV_32F))}),
                       {{4, 2}}, 1, {}, "things");
  ASSERT_TRUE(ssd);
  constexpr int kLength = 400'000;  // whose square has 480 GB
  for (const cv::Size size : {cv::Size(kLength, 4), {4, kLength}})
    EXPECT_EQ(
        ssd->find<Thing>(cv::Mat(size, CV_8UC3, cv::Scalar::all(90)), {{}, size}, 0.5F).size(), 2U);
}

}  // namespace
}  // namespace hc::people
