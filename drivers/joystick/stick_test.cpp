// SPDX-License-Identifier: Apache-2.0
#include <drivers/joystick/stick.h>

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace {

using hc::Stick;
using hc::stick_of;

Stick stick(double x, double y, double dead_zone = 0.1) {
  return stick_of(std::array{x, y}, dead_zone);
}

TEST(Stick, right_is_negative_and_down_is_positive) {
  EXPECT_EQ(stick(1, 0), (Stick{-1, 0}));
  EXPECT_EQ(stick(-1, -1), (Stick{1, -1}));
  EXPECT_EQ(stick(0, 1), (Stick{0, 1}));
}

TEST(Stick, the_dead_zone_is_0_and_what_is_beyond_begins_there) {
  EXPECT_EQ(stick(0.1, -0.1), Stick{});
  EXPECT_FALSE(std::signbit(stick(0.05, 0).left));
  EXPECT_NEAR(stick(-0.1001, 0).left, 0.0001 / 0.9, 1e-12);
  EXPECT_NEAR(stick(0, 0.55).down, 0.5, 1e-12);
  EXPECT_EQ(stick(0, 1.5).down, 1);
  EXPECT_EQ(stick(-0.25, 0.5, 0), (Stick{0.25, 0.5}));
}

TEST(Stick, too_few_axes_and_rubbish_are_the_middle) {
  EXPECT_EQ(stick_of({}, 0.1), Stick{});
  EXPECT_EQ(stick_of(std::array{1.0}, 0.1), Stick{});
  EXPECT_EQ(stick(std::nan(""), 0), Stick{});
}

}  // namespace
