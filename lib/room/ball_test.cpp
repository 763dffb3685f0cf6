// SPDX-License-Identifier: Apache-2.0
#include <room/ball.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace hc::room {

namespace {

constexpr double kStep = 0.01;  // [s]

double angle(const Ball::State& state) {
  return std::atan2(state.position.y(), state.position.x());
}

TEST(Ball, rolls_on_the_arc_at_its_speed_and_never_jumps) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Ball ball({"roll", 0.35, 2, seed});
    double fastest = 0;
    for (int i = 0; i < 6000; ++i) {
      const auto now = ball.at(i * kStep), next = ball.at((i + 1) * kStep);
      EXPECT_NEAR(now.position.head<2>().norm(), kArcRadius, 1e-9);
      EXPECT_DOUBLE_EQ(now.position.z(), kArcHeight + kBallRadius);
      EXPECT_LE(std::abs(angle(now)), kArcEnd);
      const double rate = (angle(next) - angle(now)) / kStep;
      fastest = std::max(fastest, std::abs(rate));
      // The velocity is the derivative of the position: it changes by at most 1.6 rad/s² × 10 ms.
      EXPECT_NEAR(rate,
                  now.velocity.head<2>().norm() / kArcRadius *
                      (now.position.cross(now.velocity).z() < 0 ? -1 : 1),
                  0.017);
    }
    EXPECT_NEAR(fastest, 0.35, 1e-3);
  }
}

TEST(Ball, is_the_same_for_a_seed_whenever_it_is_asked) {
  Ball forward({"roll", 0.5, 2, 7}), at_once({"roll", 0.5, 2, 7}), other({"roll", 0.5, 2, 8});
  for (int i = 0; i < 3000; ++i) (void)forward.at(i * kStep);
  EXPECT_EQ(forward.at(29.5).position, at_once.at(29.5).position);
  EXPECT_EQ(forward.at(3.25).position, Ball({"roll", 0.5, 2, 7}).at(3.25).position);
  EXPECT_NE(forward.at(29.5).position, other.at(29.5).position);
}

TEST(Ball, hides_behind_the_screen_for_its_time_and_comes_back) {
  Ball ball({"hide", 0.35, 2, 3});
  double rest = 0, longest = 0;
  int comes_back = 0;
  for (int i = 0; i < 12000; ++i) {
    const bool is_there = std::abs(angle(ball.at(i * kStep)) - kScreenAngle) < 1e-9;
    if (is_there) rest += kStep;
    if (!is_there && rest > 0) {
      longest = std::max(longest, rest);
      rest = 0;
      ++comes_back;
    }
  }
  EXPECT_NEAR(longest, 2, 0.03);
  EXPECT_GE(comes_back, 3);
}

TEST(Ball, bounces_on_the_bench_as_a_thrown_body) {
  Ball ball({"bounce", 0.35, 2, 3});
  double lowest = 9, highest = 0;
  for (int i = 0; i < 2000; ++i) {
    const double z = ball.at(i * kStep).position.z();
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
  EXPECT_NEAR(lowest, kArcHeight + kBallRadius, 0.03);
  EXPECT_NEAR(highest, kArcHeight + kBallRadius + 0.3, 0.001);
}

TEST(Ball, stays_where_it_is_when_still) {
  Ball ball({"still", 0.35, 2, 5});
  EXPECT_EQ(ball.at(0).position, ball.at(100).position);
  EXPECT_EQ(ball.at(50).velocity.norm(), 0);
}

}  // namespace

}  // namespace hc::room
