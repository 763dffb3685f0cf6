// SPDX-License-Identifier: Apache-2.0
#include <people/ssd.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

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

TEST(Ssd, parts_of_any_size_and_place_are_scaled) {
  const std::vector outputs{cv::Mat(cv::Mat::zeros(24, 6, CV_32F)),
                            cv::Mat(cv::Mat::ones(24, 1, CV_32F))};
  auto ssd = Ssd::make(std::make_unique<MadeNetwork>(nets::Shape{192, 256, 3}, outputs), {{64, 2}},
                       1, {}, "things");
  ASSERT_TRUE(ssd);
  const cv::Mat image(600, 800, CV_8UC3, cv::Scalar::all(90));
  for (const int height : {1, 199, 275, 281, 334})
    for (int width = 1; width < 600; ++width)
      EXPECT_EQ(ssd->find<Thing>(image, {width - 40, 20, width, height}, 0.5F).size(), 24U)
          << width << ' ' << height;
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
