// SPDX-License-Identifier: Apache-2.0
#include <gaze/stick.h>

#include <gtest/gtest.h>

namespace hc::gaze {
namespace {

TEST(Stick, continues_from_how_the_head_stands_while_it_is_pushed) {
  Stick stick;
  EXPECT_FALSE(stick.at(5, {}));
  EXPECT_FALSE(stick.last());
  stick.push({0.5, -0.2}, 10, {1, 0.1});
  const auto motion = stick.at(10.05, {1, 0.1});
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->angles.pan, 1.025, 1e-12);
  EXPECT_NEAR(motion->angles.tilt, 0.09, 1e-12);
  EXPECT_EQ(motion->pan_rate, 0.5);
  EXPECT_EQ(motion->tilt_rate, -0.2);
  EXPECT_EQ(stick.last(), 10);
}

TEST(Stick, other_rates_count_from_their_push_on) {
  Stick stick;
  stick.push({1, 0}, 10, {});
  stick.push({-1, 0}, 10.05, {0.05, 0});
  EXPECT_NEAR(stick.at(10.07, {0.05, 0})->angles.pan, 0.03, 1e-12);
}

TEST(Stick, stops_where_it_is_let_go) {
  Stick stick;
  stick.push({1, 0}, 10, {});
  stick.push({0, 0}, 10.04, {0.02, 0});
  const auto stopped = stick.at(10.09, {0.04, 0});
  ASSERT_TRUE(stopped);
  EXPECT_NEAR(stopped->angles.pan, 0.04, 1e-12);
  EXPECT_EQ(stopped->pan_rate, 0);
  // A centred stick does not hold the head.
  stick.push({0, 0}, 10.1, {0.04, 0});
  EXPECT_FALSE(stick.at(10.15, {0.04, 0}));
  EXPECT_EQ(stick.last(), 10);
}

TEST(Stick, a_push_that_is_not_told_again_ends) {
  Stick stick;
  stick.push({1, 0}, 10, {});
  EXPECT_TRUE(stick.at(10.09, {}));
  EXPECT_FALSE(stick.at(10.11, {}));
  stick.push({0, 0}, 10.2, {});
  EXPECT_FALSE(stick.at(10.2, {}));
  // A new deflection starts from the head's current position.
  stick.push({1, 0}, 20, {-1, 0});
  EXPECT_NEAR(stick.at(20.01, {-1, 0})->angles.pan, -0.99, 1e-12);
}

TEST(Stick, a_push_before_the_clock_was_set_has_ended) {
  for (double now : {-3590.0, 3610.0}) {
    Stick stick;
    stick.push({1, 0}, 10, {});
    EXPECT_FALSE(stick.at(now, {}));
    stick.push({1, 0}, now + 1, {-1, 0});
    EXPECT_NEAR(stick.at(now + 1.01, {-1, 0})->angles.pan, -0.99, 1e-9);
  }
}

TEST(Stick, is_never_far_ahead_of_a_head_that_cannot_follow) {
  Stick stick;
  for (double now = 10; now < 12; now += 0.05) stick.push({2, 0}, now, {0.3, 0});
  EXPECT_NEAR(stick.at(12, {0.3, 0})->angles.pan, 0.4, 1e-9);
}

}  // namespace
}  // namespace hc::gaze
