// SPDX-License-Identifier: Apache-2.0
#include <drivers/pan_tilt/motion.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace hc::pan_tilt {
namespace {

constexpr double kNear = 1e-6;  // [position, position/s], of rounding

TEST(Motion, rests_where_it_began) {
  Motion axis(12, {});
  EXPECT_EQ(axis.at(0).position, 12);
  EXPECT_EQ(axis.at(1e6).position, 12);
  EXPECT_EQ(axis.target(), 12);
}

// Closed form: up with a for v/a, along at v, down with a; x = a t²/2.
TEST(Motion, a_long_way_is_a_trapezoid) {
  Motion axis(0, {.speed = 1000, .acceleration = 2000});
  axis.go(2, 2000);
  EXPECT_NEAR(axis.end(), 2 + 2000 / 1000.0 + 1000 / 2000.0, kNear);
  EXPECT_NEAR(axis.at(2.25).position, 2000 * 0.25 * 0.25 / 2, kNear);
  EXPECT_NEAR(axis.at(2.25).speed, 500, kNear);
  EXPECT_NEAR(axis.at(3.5).position, 250 + 1000, kNear);
  EXPECT_NEAR(axis.at(3.5).speed, 1000, kNear);
  EXPECT_NEAR(axis.at(4.25).position, 2000 - 2000 * 0.25 * 0.25 / 2, kNear);
  EXPECT_EQ(axis.at(4.5).position, 2000);
  EXPECT_EQ(axis.at(9).speed, 0);
}

TEST(Motion, a_short_way_is_a_triangle_to_either_side) {
  for (double sign : {1, -1}) {
    Motion axis(0, {.speed = 1000, .acceleration = 2000});
    axis.go(0, sign * 80);
    EXPECT_NEAR(axis.end(), 2 * std::sqrt(80 / 2000.0), kNear);
    EXPECT_NEAR(axis.at(0.2).position, sign * 40, kNear);
    EXPECT_NEAR(axis.at(0.2).speed, sign * 400, kNear);
  }
}

TEST(Motion, below_the_base_speed_there_is_no_acceleration) {
  Motion axis(0, {.speed = 500, .acceleration = 2000, .base = 1000});
  axis.go(0, 250);
  EXPECT_NEAR(axis.end(), 0.5, kNear);
  EXPECT_NEAR(axis.at(0.1).position, 50, kNear);
  axis.halt(0.2);
  EXPECT_NEAR(axis.at(0.2).position, 100, kNear);
  EXPECT_EQ(axis.at(0.2).speed, 0);
}

// From base to speed: (v² - b²) / 2a up, and the same down.
TEST(Motion, above_the_base_speed_it_accelerates_from_there) {
  Motion axis(0, {.speed = 2000, .acceleration = 2000, .base = 1000});
  axis.go(0, 2500);
  EXPECT_NEAR(axis.at(0.5).position, 750, kNear);
  EXPECT_NEAR(axis.at(0.5).speed, 2000, kNear);
  EXPECT_NEAR(axis.end(), 0.5 + 1000 / 2000.0 + 0.5, kNear);
}

TEST(Motion, a_new_target_on_the_way_is_taken_up_smoothly) {
  Motion axis(0, {.speed = 1000, .acceleration = 2000});
  axis.go(0, 2000);
  axis.go(1, 3000);  // keeps cruising, as if commanded so from the start
  EXPECT_NEAR(axis.end(), 3.5, kNear);
  axis.go(1.5, 0);  // at 1250 with 1000: 0.5 s and 250 to stop, and 1500 back
  EXPECT_NEAR(axis.at(1.5).speed, 1000, kNear);
  EXPECT_NEAR(axis.at(2).position, 1500, kNear);
  EXPECT_NEAR(axis.end(), 2 + 1.5 + 0.5, kNear);
  EXPECT_EQ(axis.at(4).position, 0);
}

TEST(Motion, a_target_that_is_too_near_is_passed_and_come_back_to) {
  Motion axis(0, {.speed = 1000, .acceleration = 2000});
  axis.go(0, 2000);
  axis.go(1, 760);  // at 750 with 1000
  EXPECT_NEAR(axis.at(1.5).position, 1000, kNear);
  EXPECT_EQ(axis.at(10).position, 760);
}

TEST(Motion, a_pace_changes_on_the_way) {
  Motion axis(0, {.speed = 1000, .acceleration = 2000});
  axis.go(0, 2000);
  axis.set_pace(1, {.speed = 500, .acceleration = 1000});  // at 750 with 1000
  EXPECT_NEAR(axis.at(1.5).speed, 500, kNear);
  EXPECT_NEAR(axis.at(1.5).position, 750 + 375, kNear);
  EXPECT_NEAR(axis.end(), 1.5 + (2000 - 1125 - 125) / 500.0 + 0.5, kNear);
}

TEST(Motion, a_halt_brakes) {
  Motion axis(0, {.speed = 1000, .acceleration = 2000});
  axis.go(0, 2000);
  axis.halt(1);
  EXPECT_NEAR(axis.target(), 750 + 250, kNear);
  EXPECT_NEAR(axis.end(), 1.5, kNear);
  EXPECT_NEAR(axis.at(9).position, 1000, kNear);
}

TEST(Motion, whatever_is_asked_for_position_and_speed_keep_to_the_pace) {
  std::mt19937 random(7);
  auto anything_to = [&](double most) {
    return most * static_cast<double>(random() % 10001) / 10000;
  };
  for (int run = 0; run < 200; ++run) {
    Pace pace{10 + anything_to(2900), 10 + anything_to(4000), 0};
    Motion axis(anything_to(100), pace);
    double fastest = pace.speed, steepest = pace.acceleration;
    Motion::State before = axis.at(0);
    double time = 0;
    for (int step = 0; step < 400; ++step) {
      time += 0.005;
      const auto state = axis.at(time);
      EXPECT_LE(std::abs(state.speed), fastest + kNear);
      EXPECT_LE(std::abs(state.speed - before.speed), steepest * 0.005 + kNear);
      EXPECT_LE(std::abs(state.position - before.position), fastest * 0.005 + kNear);
      before = state;
      if (random() % 20 == 0) axis.go(time, anything_to(6000) - 3000);
      if (random() % 90 == 0) axis.halt(time);
      if (random() % 60 == 0) {
        pace = {10 + anything_to(2900), 10 + anything_to(4000), 0};
        fastest = std::max(fastest, pace.speed);
        steepest = std::max(steepest, pace.acceleration);
        axis.set_pace(time, pace);
      }
    }
    EXPECT_NEAR(axis.at(axis.end()).position, axis.target(), kNear);
    EXPECT_EQ(axis.at(axis.end() + 1).position, axis.target());
  }
}

}  // namespace
}  // namespace hc::pan_tilt
