// SPDX-License-Identifier: Apache-2.0
#include <gaze/follower.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace hc::gaze {
namespace {

TEST(Follower, finds_place_and_rate_of_what_moves_evenly) {
  Follower follower({});
  for (int i = 0; i < 20; ++i) {
    const double t = 100 + 0.05 * i;
    follower.see(t, {0.35 * (t - 100), -0.1});
  }
  const auto motion = follower.at(101.05);  // 0.1 s after it was seen
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->angles.pan, 0.35 * 1.05, 1e-3);
  EXPECT_NEAR(motion->pan_rate, 0.35, 1e-2);
  EXPECT_NEAR(motion->angles.tilt, -0.1, 1e-6);
}

TEST(Follower, is_quieter_than_what_it_sees) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.01);
  Follower follower({0.01, 0.5, 0.5});
  double seen = 0, followed = 0;
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.05 * i, truth = 0.3 * std::sin(0.5 * t), error = noise(random);
    follower.see(t, {truth + error, 0});
    if (i < 20) continue;
    seen += error * error;
    followed += std::pow(follower.at(t)->angles.pan - truth, 2);
  }
  EXPECT_LT(std::sqrt(followed), 0.8 * std::sqrt(seen));
}

TEST(Follower, starts_over_after_a_gap_and_leaves_the_past_alone) {
  Follower follower({});
  EXPECT_FALSE(follower.at(1));
  for (int i = 0; i < 10; ++i) follower.see(0.05 * i, {0.02 * i, 0});
  follower.see(0.2, {9, 9});  // older than the last
  EXPECT_NEAR(follower.at(0.45)->angles.pan, 0.18, 1e-2);
  follower.see(2, {-0.5, 0.2});
  EXPECT_DOUBLE_EQ(follower.at(2)->angles.pan, -0.5);
  EXPECT_DOUBLE_EQ(follower.at(2)->pan_rate, 0);
  follower.forget();
  EXPECT_FALSE(follower.at(2));
}

TEST(Follower, what_is_not_seen_stops_at_the_horizon) {
  Follower follower({});
  for (int i = 0; i < 20; ++i) follower.see(0.05 * i, {0.05 * i, 0});
  const auto at_once = follower.at(1), later = follower.at(5);
  EXPECT_NEAR(at_once->pan_rate, 1, 0.01);
  EXPECT_NEAR(later->angles.pan, 0.95 + 0.2, 0.01);
  EXPECT_EQ(later->pan_rate, 0);
}

TEST(Follower, a_clock_that_is_set_back_starts_over) {
  Follower follower({});
  follower.see(1000, {0.1, 0});
  follower.see(990, {0.5, 0});
  EXPECT_EQ(follower.last(), 990);
  EXPECT_EQ(follower.at(990)->angles.pan, 0.5);
}

TEST(Follower, half_a_turn_to_either_side_is_the_same) {
  Follower follower({});
  for (int i = 0; i < 20; ++i) follower.see(0.02 * i, {std::remainder(3 + 0.02 * i, 2 * M_PI), 0});
  EXPECT_NEAR(follower.at(0.38)->angles.pan, 3.38, 1e-3);
  EXPECT_NEAR(follower.at(0.38)->pan_rate, 1, 1e-2);
}

TEST(Follower, a_leap_is_no_motion) {
  Follower follower({});
  for (int i = 0; i < 20; ++i) follower.see(0.05 * i, {0, 0});
  follower.see(1, {0.8, 0.1});
  EXPECT_EQ(follower.at(1.1)->angles.pan, 0.8);
  EXPECT_EQ(follower.at(1.1)->pan_rate, 0);
}

TEST(Follower, a_leap_after_a_pause_is_no_motion) {
  for (const double pause : {0.1, 0.2, 0.3, 0.4, 0.5}) {
    Follower follower({});
    for (int i = 0; i < 20; ++i) follower.see(0.05 * i, {0, 0});
    const double then = 0.95 + pause;
    follower.see(then, {1.1, 0});
    EXPECT_EQ(follower.at(then + 0.1)->angles.pan, 1.1) << pause;
    EXPECT_EQ(follower.at(then + 0.1)->pan_rate, 0) << pause;
  }
}

TEST(Follower, a_pause_in_fast_motion_is_no_leap) {
  Follower follower({});
  for (int i = 0; i < 400; ++i) {
    const double t = 0.05 * i, since = std::fmod(t, 2.0);
    if (t > 1 && since < 0.3) continue;
    follower.see(t, {0.8 * std::sin(2 * t), 0});
    if (t > 1 && since < 0.35) {
      EXPECT_NE(follower.at(t)->pan_rate, 0) << t;
    }
  }
}

TEST(Follower, smooth_acceleration_is_no_leap) {
  // A person who shakes the head, at 100 measurements a second.
  constexpr double kAmplitude = 0.9, kAngular = 1.4;
  Follower follower({0.0005, 2, 0.5, 0.1});
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.01 * i;
    follower.see(t, {kAmplitude * std::sin(kAngular * t), 0});
    if (t < 1) continue;
    const double rate = kAmplitude * kAngular * std::cos(kAngular * t);
    ASSERT_NEAR(follower.at(t)->pan_rate, rate, 0.05) << t;
  }
}

TEST(Follower, braking_is_what_a_unit_needs_to_stand_still) {
  EXPECT_DOUBLE_EQ(braking(2, {4, 0}), 0.5);
  EXPECT_DOUBLE_EQ(braking(-2, {4, 0}), -0.5);
  EXPECT_DOUBLE_EQ(braking(2, {4, 1}), 0.375);
  EXPECT_DOUBLE_EQ(braking(-1, {4, 1}), 0);
}

/// RMS error of predictions 0.1 s ahead, of tilt, at 20 images a second [rad].
double prediction_error(double (*tilt)(double)) {
  Follower follower{FollowerOptions{}};
  double sum = 0;
  int count = 0;
  for (int i = 0; i < 400; ++i) {
    const double t = 0.05 * i;
    follower.see(t, {0.1 * t, tilt(t)});
    if (t < 3) continue;
    const double off = follower.at(t + 0.1)->angles.tilt - tilt(t + 0.1);
    sum += off * off;
    ++count;
    EXPECT_NEAR(follower.at(t + 0.1)->angles.pan, 0.1 * (t + 0.1), 0.01);
  }
  return std::sqrt(sum / count);
}

TEST(Follower, what_bounces_faster_than_can_be_predicted_is_followed_by_its_middle) {
  // A ball that bounces 0.3 m high, 2.4 m away: staying at the mean would be 0.037 off.
  const double error = prediction_error([](double t) {
    const double rise = std::sqrt(2 * 0.3 / 9.81), since_top = std::fmod(t, 2 * rise) - rise;
    return (0.3 - 9.81 * since_top * since_top / 2) / 2.4;
  });
  EXPECT_LT(error, 0.05);
}

TEST(Follower, what_swings_slowly_is_followed) {
  EXPECT_LT(prediction_error([](double t) { return 0.2 * std::sin(2 * t); }), 0.01);
}

}  // namespace
}  // namespace hc::gaze
