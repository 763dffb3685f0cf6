// SPDX-License-Identifier: Apache-2.0
#include <people/ssd.h>

#include <gtest/gtest.h>

#include <array>

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

}  // namespace
}  // namespace hc::people
