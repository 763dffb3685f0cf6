// SPDX-License-Identifier: Apache-2.0
#include <room/screen.h>

#include <gtest/gtest.h>

#include <cmath>

#include <room/ball.h>

namespace hc::room {

namespace {

const Eigen::Vector3d kNeck(0, 0, kHeadHeight);

/// The ball on its bench. @param angle  to the left [rad].
Eigen::Vector3d ball_at(double angle) {
  return {kArcRadius * std::cos(angle), kArcRadius * std::sin(angle), kArcHeight + kBallRadius};
}

TEST(Screen, hides_the_ball_behind_it_alone) {
  EXPECT_EQ(share_seen(ball_at(kScreenAngle), kNeck), 0);
  EXPECT_EQ(share_seen(ball_at(0.3), kNeck), 1);
}

TEST(Screen, lets_more_of_the_ball_be_seen_the_farther_it_is_from_the_middle) {
  double last = 0;
  for (double off = 0.1; off < 0.25; off += 0.01) {
    const double share = share_seen(ball_at(kScreenAngle + off), kNeck);
    EXPECT_GE(share, last) << off;
    EXPECT_NEAR(share, share_seen(ball_at(kScreenAngle - off), kNeck), 0.05) << off;
    last = share;
  }
  EXPECT_EQ(last, 1);
}

TEST(Screen, hides_nothing_before_it_and_from_above) {
  EXPECT_EQ(share_seen(0.5 * ball_at(kScreenAngle), kNeck), 1);
  EXPECT_EQ(share_seen(ball_at(kScreenAngle), ball_at(kScreenAngle) + Eigen::Vector3d(0, 0, 2)), 1);
}

}  // namespace

}  // namespace hc::room
