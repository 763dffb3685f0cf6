// SPDX-License-Identifier: Apache-2.0
#include <vision/board_coverage.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <vision/board_pose_test.h>
#include <vision/squinting_pair_test.h>

namespace hc::vision {
namespace {

/// A view of the board with its centre there [m], tilted [rad].
BoardView view_at(const StereoCalibration& cameras, const cv::Vec3d& centre,
                  const cv::Vec3d& turn = {}) {
  return view_of(kTestBoard, BoardPose::at(kTestBoard, turn, centre), cameras);
}

/// The next view of a person that follows the advice.
BoardView view_by(const std::string& advice, const StereoCalibration& cameras) {
  const std::map<std::string, cv::Vec3d> turns = {{"to the left (the left", {0, 0.5, 0}},
                                                  {"to the right (the right", {0, -0.5, 0}},
                                                  {"back (the upper", {-0.5, 0, 0}},
                                                  {"forward (the lower", {0.5, 0, 0}}};
  for (const auto& [words, turn] : turns)
    if (advice.find("tilt the board " + words + " edge in the image farther away)") !=
        std::string::npos)
      return view_at(cameras, {0.05, 0, 0.7}, turn);
  const auto has = [&](const char* word) { return advice.find(word) != std::string::npos; };
  const double x = has("left") ? -0.2 : has("right") ? 0.3 : 0.05;
  const double y = has("top") || has("upper") ? -0.2 : has("bottom") || has("lower") ? 0.2 : 0;
  return view_at(cameras, {x, y, 0.7});
}

TEST(BoardCoverage, is_complete_after_what_it_asks_for) {
  const auto cameras = squinting();
  std::vector<BoardView> views;
  std::vector<std::string> asked;
  constexpr std::size_t kTilts = 8, kMost = 17;  // two each, and nine parts of the images
  for (;;) {
    asked.push_back(coverage_of(views, kTestBoard, cameras.size).advice());
    if (asked.back().empty()) break;
    ASSERT_LT(views.size(), kMost) << asked.back();
    views.push_back(view_by(asked.back(), cameras));
  }
  EXPECT_EQ(asked.front(), "tilt the board to the left (the left edge in the image farther away)");
  EXPECT_EQ(asked[kTilts], "move the board to the top left corner of the images");
}

TEST(BoardCoverage, tilts_are_told_apart_from_another_focal_length_and_order_of_corners) {
  for (const double focal : {400, 1200}) {
    const auto cameras = ideal_pair({800, 600}, focal, 0.06);
    auto view = view_at(cameras, {0, 0, focal / 800}, {0, 0.6, 0});
    EXPECT_EQ(coverage_of({&view, 1}, kTestBoard, cameras.size).tilts,
              (std::array<std::size_t, 4>{1, 0, 0, 0}))
        << focal;
    std::reverse(view.left.begin(), view.left.end());
    EXPECT_EQ(coverage_of({&view, 1}, kTestBoard, cameras.size).tilts[0], 1U) << focal;
  }
}

}  // namespace
}  // namespace hc::vision
