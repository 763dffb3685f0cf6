// SPDX-License-Identifier: Apache-2.0
#include "score.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

/// A hand whose tip is at the origin, and whose joints are at a place in the image.
hc::room::TrueHand hand_at(const Eigen::Vector3d& tip, double x) {
  hc::room::TrueHand hand;
  hand.joints.fill(tip);
  hand.pixels.fill({x, 100});
  return hand;
}

std::array<Eigen::Vector2d, kJoints> joints_at(double x) {
  std::array<Eigen::Vector2d, kJoints> joints;
  joints.fill({x, 100});
  return joints;
}

TEST(PointAtScore, is_the_angle_at_the_tip_of_the_hand_that_points) {
  TrueScene scene{{hand_at({-1, 0, 0}, 0), hand_at({0, 0, 0}, 0)}, Eigen::Vector3d(2, 0, 0)};
  Score score;
  score.add_place(scene, {1, 1, 0});
  EXPECT_NEAR(score.numbers()[0], M_PI / 4, 1e-9);
  score.add_place(scene, {3, 0, 0});
  score.add_place(scene, {0, 2, 0});
  EXPECT_NEAR(score.numbers()[0], M_PI / 4, 1e-9) << "the median";
  EXPECT_EQ(score.numbers()[2], 3);
}

TEST(PointAtScore, needs_somebody_who_points) {
  Score score;
  score.add_place({{hand_at({0, 0, 0}, 0)}, std::nullopt}, {1, 0, 0});
  score.add_place({{}, Eigen::Vector3d(1, 0, 0)}, {1, 0, 0});
  EXPECT_EQ(score.numbers()[2], 0);
  EXPECT_EQ(score.numbers()[0], -1);
  EXPECT_EQ(score.text(), "no hand was found");
}

TEST(PointAtScore, joints_are_compared_with_those_of_the_nearest_hand) {
  const TrueScene scene{{hand_at({0, 0, 0}, 100), hand_at({0, 0, 0}, 300)}, std::nullopt};
  Score score;
  score.add_hand(scene, joints_at(290));
  score.add_hand(scene, joints_at(600));  // of nobody
  EXPECT_NEAR(score.numbers()[1], 10, 1e-9);
  EXPECT_EQ(score.numbers()[3], 1);
}

}  // namespace
