// SPDX-License-Identifier: Apache-2.0
#include <people/hand_command.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

namespace {

using namespace std::chrono_literals;
using hc::people::HandCommand;
using hc::people::Sign;

constexpr double kPalm = 0.05;  // [rad]

/// A hand, by pan and tilt of its wrist [rad]; its tip is farther from the elbow than that.
HandCommand::Directions upright(double pan, double tilt = 0, double length = kPalm) {
  const auto towards = [&](double height) -> Eigen::Vector3d {
    return Eigen::Vector3d(std::cos(pan), std::sin(pan), std::tan(tilt + height)).normalized();
  };
  return {towards(0), towards(length), towards(1.8 * length)};
}

/// How often a hand that shows a sign for four seconds, and moves so, gives a command.
template <typename HandAt>
int commands(Sign sign, const HandAt& hand_at) {
  HandCommand command;
  int count = 0;
  for (auto at = 0ms; at < 4s; at += 50ms) {
    const auto told = command.update(hc::Time(1'700'000'000s) + at, sign,
                                     hand_at(static_cast<double>(at.count()) / 1000));
    if (!told) continue;
    EXPECT_EQ(*told, sign);
    EXPECT_GE(at, HandCommand::kHold);
    ++count;
  }
  return count;
}

TEST(HandCommand, is_a_sign_that_is_held_still) {
  const auto trembles = [](double t) { return upright(0.1 + 0.1 * kPalm * std::sin(40 * t)); };
  EXPECT_EQ(commands(Sign::Open, trembles), 1);
  EXPECT_EQ(commands(Sign::ThumbUp, trembles), 1);
  EXPECT_EQ(commands(Sign::None, trembles), 0);
}

TEST(HandCommand, is_no_wave) {
  for (const double rate : {0.8, 1.5, 3.0})
    EXPECT_EQ(commands(Sign::Open,
                       [&](double t) {
                         return upright(2 * kPalm * std::sin(2 * std::numbers::pi * rate * t));
                       }),
              0)
        << rate;
}

TEST(HandCommand, is_no_wave_along_the_line_of_sight) {
  // At the wrist, by 0.9 rad: of its knuckle alone, the hand seems to be still.
  const auto waves = [](double t) {
    return upright(0, 0, kPalm * std::cos(0.9 * std::sin(2 * std::numbers::pi * 1.5 * t)));
  };
  EXPECT_EQ(commands(Sign::Open, waves), 0);
}

/// How long a hand is seen at rest until it gives a command.
/// @param passed  since an image in which it was elsewhere; nothing: there is none.
/// @param apart  time between two images
std::chrono::milliseconds rest_until_command(std::optional<std::chrono::milliseconds> passed,
                                             std::chrono::milliseconds apart) {
  HandCommand command;
  const hc::Time first(1'700'000'000s);
  if (passed) command.update(first - *passed, Sign::Open, upright(kPalm));
  for (auto at = 0ms; at < 3s; at += apart)
    if (command.update(first + at, Sign::Open, upright(0))) return at;
  return -1ms;
}

TEST(HandCommand, counts_from_the_middle_between_motion_and_rest) {
  EXPECT_EQ(rest_until_command(120ms, 120ms), 480ms);  // and the 60 ms before
  EXPECT_EQ(rest_until_command(120ms, 110ms), 440ms);
  EXPECT_EQ(rest_until_command(240ms, 10ms), 380ms);
  EXPECT_EQ(rest_until_command(80ms, 80ms), 480ms);
  // It may have been at rest for any part of a longer time.
  EXPECT_EQ(rest_until_command(260ms, 10ms), 500ms);
  EXPECT_EQ(rest_until_command({}, 10ms), 500ms);
}

TEST(HandCommand, starts_again_after_an_image_without_a_sign) {
  HandCommand command;
  EXPECT_FALSE(command.update(hc::Time(1s), Sign::None, std::nullopt));
  EXPECT_FALSE(command.update(hc::Time(1s) + 50ms, Sign::Open, upright(0)));
  EXPECT_FALSE(command.update(hc::Time(1s) + 200ms, Sign::Open, upright(0)));
  EXPECT_FALSE(command.update(hc::Time(1s) + 400ms, Sign::Open, upright(0)));
  EXPECT_FALSE(command.update(hc::Time(1s) + 500ms, Sign::Open, upright(0)));
  EXPECT_TRUE(command.update(hc::Time(1s) + 550ms, Sign::Open, upright(0)));
}

TEST(HandCommand, is_no_hand_that_passes_by) {
  EXPECT_EQ(commands(Sign::Open, [](double t) { return upright(0.1 * t); }), 0);
}

TEST(HandCommand, needs_a_hand_that_is_seen_all_the_time) {
  HandCommand command;
  for (int i = 0; i < 20; ++i)
    EXPECT_FALSE(command.update(hc::Time(1'700'000'000s) + i * 300ms, Sign::Open, upright(0)));
}

TEST(HandCommand, comes_when_a_wave_ends) {
  EXPECT_EQ(commands(Sign::Open, [](double t) { return upright(t < 1 ? 0.2 * t : 0.2); }), 1);
}

}  // namespace
