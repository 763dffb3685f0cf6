// SPDX-License-Identifier: Apache-2.0
#include "score.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

constexpr double kFrame = 0.05;  // [s]

/// A hand at a place, with straight fingers.
ShownHand straight_hand(double y, const Eigen::Vector3d& fingers = {0, 0, 1}) {
  ShownHand hand{{1, 1, {}, {}}, true};
  for (std::size_t i = 0; i < hc::room::kHandJoints; ++i)
    hand.hand.joints[i] =
        Eigen::Vector3d(2, y, 1.4) + 0.03 * static_cast<double>((i + 3) % 4) * fingers;
  hand.hand.joints[0] = {2, y, 1.3};
  return hand;
}

ShownHand hanging() {
  return straight_hand(0, {0, 0, -1});
}

/// A palm that rises within half a second and is held for a second; then none for two.
void hold_up(StopScore& score, double begin, double stop_after) {
  for (int i = 0; i < 10; ++i) score.see(begin - 0.5 + i * kFrame, {straight_hand(0.5 - 0.05 * i)});
  bool has_stopped = false;
  for (int i = 0; i < 60; ++i) {
    const double time = begin + i * kFrame;
    score.see(time, {i < 20 ? straight_hand(0) : hanging()});
    if (!has_stopped && i * kFrame >= stop_after) {
      score.stop(begin + stop_after);
      has_stopped = true;
    }
  }
}

TEST(Palm, is_open_with_its_fingers_up) {
  EXPECT_TRUE(is_palm_up(straight_hand(0).hand));
  EXPECT_TRUE(is_palm_up(straight_hand(0, Eigen::Vector3d(0, 0.5, 1).normalized()).hand));
  EXPECT_FALSE(is_palm_up(straight_hand(0, {0, 1, 0}).hand));
  EXPECT_FALSE(is_palm_up(hanging().hand));
  auto bent = straight_hand(0).hand;
  bent.joints[20] = bent.joints[18];
  EXPECT_FALSE(is_palm_up(bent));
}

TEST(StopScore, is_the_time_from_the_first_image_of_a_palm_that_is_held) {
  StopScore score;
  hold_up(score, 10, 0.6);
  score.go();
  hold_up(score, 20, 0.7);
  score.go();
  hold_up(score, 30, 0.65);
  const auto numbers = score.numbers();
  EXPECT_NEAR(numbers[0], 0.65, 1e-9);
  EXPECT_NEAR(numbers[1], 0.7, 1e-9);
  EXPECT_EQ(numbers[2], 3);
  EXPECT_EQ(numbers[3], 3);
  EXPECT_EQ(numbers[4], 0);
  EXPECT_NEAR(numbers[6], 23.45, 1e-9);
  EXPECT_EQ(score.text(),
            "missed 0 of 3 palms, stopped after 0.650 s median, 0.700 s at most; 0 stops without a "
            "palm, 0 by one at the border, in 23 s");
}

TEST(StopScore, a_stop_may_come_a_little_after_the_palm) {
  StopScore score;
  for (int i = 0; i < 20; ++i) score.see(i * kFrame, {straight_hand(0)});
  for (int i = 20; i < 30; ++i)  // still open, it sinks
    score.see(i * kFrame, {straight_hand(0.05 * (i - 20))});
  score.stop(1.4);
  EXPECT_EQ(score.text(),
            "missed 0 of 1 palms, stopped after 1.400 s median, 1.400 s at most; 0 stops without a "
            "palm, 0 by one at the border, in 1 s");
  for (int i = 30; i < 60; ++i) score.see(i * kFrame, {hanging()});
  score.go();
  score.stop(2.9);
  EXPECT_EQ(score.numbers()[3], 1);
  EXPECT_EQ(score.numbers()[4], 1) << "much later";
}

TEST(StopScore, counts_palms_that_did_not_stop_it) {
  StopScore score;
  hold_up(score, 10, 99);
  EXPECT_EQ(
      score.text(),
      "missed 1 of 1 palms, stopped after -1.000 s median, -1.000 s at most; 0 stops without a "
      "palm, 0 by one at the border, in 3 s");
  EXPECT_EQ(score.numbers()[0], -1);
}

TEST(StopScore, counts_stops_without_a_palm) {
  StopScore score;
  for (int i = 0; i < 100; ++i) {
    // It waves: to and fro within a second, and so it never stays.
    score.see(i * kFrame, {straight_hand(0.1 * std::sin(6 * i * kFrame))});
    if (i == 50 || i == 51 || i == 80) score.stop(i * kFrame);
    if (i == 60) score.go();
  }
  EXPECT_EQ(score.text(), "2 stops without a palm, 0 by one at the border, in 5 s");
}

TEST(StopScore, a_stop_that_comes_before_a_palm_was_held_is_none_of_its) {
  StopScore score;
  hold_up(score, 10, 0.1);
  EXPECT_EQ(score.numbers()[4], 1);
  EXPECT_EQ(score.numbers()[3], 0) << "a robot that is stopped cannot be stopped";
  EXPECT_EQ(score.numbers()[2], 0);
}

TEST(StopScore, a_palm_stops_it_once) {
  StopScore score;
  for (int i = 0; i < 30; ++i) score.see(i * kFrame, {straight_hand(0)});
  score.stop(1);
  score.go();
  score.stop(1.4);
  EXPECT_EQ(score.numbers()[2], 1);
  EXPECT_EQ(score.numbers()[4], 1);
}

TEST(StopScore, of_two_palms_at_once_either_may_stop_it) {
  StopScore score;
  auto other = straight_hand(1);
  other.hand.person = 2;
  for (int i = 0; i < 20; ++i)
    score.see(i * kFrame,
              i < 5 ? std::vector{straight_hand(0)} : std::vector{straight_hand(0), other});
  score.stop(1);
  for (int i = 20; i < 60; ++i) score.see(i * kFrame, {});
  EXPECT_EQ(score.numbers()[2], 1);
  EXPECT_EQ(score.numbers()[3], 1) << "the other one was no miss";
  EXPECT_NEAR(score.numbers()[1], 1, 1e-9);
}

TEST(StopScore, a_palm_that_is_not_whole_in_the_image_may_stop_or_not) {
  auto outside = straight_hand(0);
  outside.is_in_image = false;
  for (const bool stops : {false, true}) {
    StopScore score;
    for (int i = 0; i < 20; ++i) score.see(i * kFrame, {outside});
    if (stops) score.stop(1);
    for (int i = 20; i < 60; ++i) score.see(i * kFrame, {});
    EXPECT_EQ(score.numbers()[3], 0);
    EXPECT_EQ(score.numbers()[4], 0);
    EXPECT_EQ(score.numbers()[5], stops ? 1 : 0);
  }
}

TEST(StopScore, a_palm_that_comes_into_the_image_counts_from_then) {
  StopScore score;
  auto palm = straight_hand(0);
  for (int i = 0; i < 60; ++i) {
    palm.is_in_image = i >= 10;
    score.see(i * kFrame, {palm});
    if (i == 22) score.stop(i * kFrame);
  }
  EXPECT_NEAR(score.numbers()[0], 0.6, 1e-9);
  EXPECT_EQ(score.numbers()[3], 1);
}

TEST(StopScore, a_palm_that_trembles_at_the_border_may_stop_or_not) {
  StopScore score;
  for (int i = 0; i < 60; ++i) {
    auto palm = straight_hand(0);
    palm.is_in_image = i % 4 != 0;
    score.see(i * kFrame, {palm});
    if (i == 20) score.stop(i * kFrame);
  }
  EXPECT_EQ(score.numbers()[3], 0);
  EXPECT_EQ(score.numbers()[4], 0);
  EXPECT_EQ(score.numbers()[5], 1);
}

TEST(StopScore, a_palm_that_stopped_nothing_is_missed_wherever_it_goes_then) {
  StopScore score;
  auto palm = straight_hand(0);
  for (int i = 0; i < 40; ++i) score.see(i * kFrame, {palm});
  palm.is_in_image = false;
  score.see(40 * kFrame, {palm});
  for (int i = 41; i < 80; ++i) score.see(i * kFrame, {});
  EXPECT_EQ(score.numbers()[2], 0);
  EXPECT_EQ(score.numbers()[3], 1);
}

TEST(StopScore, a_stop_is_cleared_a_while_after_the_palm) {
  StopScore score;
  for (int i = 0; i <= 20; ++i) score.see(i * kFrame, {straight_hand(0)});
  EXPECT_FALSE(score.wants_to_go(9)) << "it goes";
  score.stop(1);
  EXPECT_FALSE(score.wants_to_go(1.4));
  EXPECT_TRUE(score.wants_to_go(1.6));
  score.go();
  EXPECT_FALSE(score.wants_to_go(1.6));
}

}  // namespace
