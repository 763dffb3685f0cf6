// SPDX-License-Identifier: Apache-2.0
#include <graphics/occlusion.h>

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace hc::graphics {
namespace {

/// A row of depth from its nearness at a scale of 1; 0: unknown.
cv::Mat row_of(const std::vector<float>& nearness) {
  cv::Mat depth(1, static_cast<int>(nearness.size()), CV_32F);
  for (int x = 0; x < depth.cols; ++x) {
    const float d = nearness[static_cast<std::size_t>(x)];
    depth.at<float>(0, x) = d == 0 ? 0 : 1 / d;
  }
  return depth;
}

std::vector<float> left_of(const std::vector<float>& nearness) {
  cv::Mat found;
  nearness_of(false, row_of(nearness), 1, {0, 0, static_cast<int>(nearness.size()), 1}, found);
  return found.reshape(1, 1);
}

std::vector<float> right_of(const std::vector<float>& nearness) {
  cv::Mat found;
  nearness_of(true, row_of(nearness), 1, {0, 0, static_cast<int>(nearness.size()), 1}, found);
  return found.reshape(1, 1);
}

TEST(Occlusion, a_hole_belongs_to_what_is_further_away) {
  EXPECT_EQ(left_of({1, 0, 0, 4}), (std::vector<float>{1, 1, 1, 4}));
  EXPECT_EQ(left_of({4, 0, 0, 1}), (std::vector<float>{4, 1, 1, 1}));
}

TEST(Occlusion, at_the_edges_a_hole_is_as_what_is_beside_it) {
  EXPECT_EQ(left_of({0, 0, 4, 1, 0}), (std::vector<float>{4, 4, 4, 1, 1}));
  EXPECT_EQ(left_of({0, 0, 0}), (std::vector<float>{0, 0, 0}));
}

TEST(Occlusion, the_right_eye_sees_what_is_near_further_left_and_before_the_rest) {
  // The two pixels of nearness 4 move by 4 and hide those of nearness 1, which move by 1; pixels
  // that the left eye does not see, 4 and 5, are far.
  EXPECT_EQ(right_of({1, 1, 1, 1, 1, 1, 4, 4, 1, 1}),
            (std::vector<float>{1, 1, 4, 4, 1, 1, 1, 1, 1, 1}));
}

TEST(Occlusion, a_slanted_surface_has_no_gaps_for_the_right_eye) {
  // Depth increases to the right, so that the right eye sees it wider.
  std::vector<float> slanted(40);
  for (std::size_t x = 0; x < slanted.size(); ++x) slanted[x] = 20 - 0.4F * static_cast<float>(x);
  const auto seen = right_of(slanted);
  for (std::size_t x = 1; x + 8 < seen.size(); ++x) {
    EXPECT_LE(seen[x], seen[x - 1]) << x;
    EXPECT_LT(seen[x - 1] - seen[x], 0.5) << x;
  }
}

TEST(Occlusion, a_part_is_as_in_the_whole) {
  cv::Mat depth(20, 30, CV_32F), whole, part;
  cv::randu(depth, 0.1, 5.0);
  const cv::Rect window(7, 3, 11, 9);
  for (const bool is_right : {false, true}) {
    nearness_of(is_right, depth, 10, {0, 0, 30, 20}, whole);
    nearness_of(is_right, depth, 10, window, part);
    EXPECT_EQ(cv::norm(whole(window), part, cv::NORM_INF), 0);
  }
}

TEST(Occlusion, no_depth_is_too_strange) {
  using Limits = std::numeric_limits<float>;
  const float strange[] = {Limits::quiet_NaN(),  Limits::infinity(), -1,
                           Limits::denorm_min(), Limits::max(),      0};
  cv::Mat depth(1, 6, CV_32F), found;
  for (int x = 0; x < 6; ++x) depth.at<float>(0, x) = strange[x];
  for (const bool is_right : {false, true}) {
    nearness_of(is_right, depth, 60, {0, 0, 6, 1}, found);
    EXPECT_TRUE(cv::checkRange(found));
  }
}

}  // namespace
}  // namespace hc::graphics
