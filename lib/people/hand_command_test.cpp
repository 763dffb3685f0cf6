// SPDX-License-Identifier: Apache-2.0
#include <people/hand_command.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using namespace std::chrono_literals;
using hc::people::HandCommand;
using hc::people::Sign;

constexpr double kPalm = 0.05;  // [rad]

/// How often a hand that shows a sign for four seconds, and moves so, gives a command.
template <typename Pan>
int commands(Sign sign, const Pan& pan) {
  HandCommand command;
  int count = 0;
  for (auto at = 0ms; at < 4s; at += 50ms) {
    const double angle = pan(static_cast<double>(at.count()) / 1000);
    const Eigen::Vector3d towards(std::cos(angle), std::sin(angle), 0);
    const auto told = command.update(hc::Time(1'700'000'000s) + at, sign, towards, kPalm);
    if (!told) continue;
    EXPECT_EQ(*told, sign);
    EXPECT_GE(at, HandCommand::kHold);
    ++count;
  }
  return count;
}

TEST(HandCommand, is_a_sign_that_is_held_still) {
  const auto trembles = [](double t) { return 0.1 + 0.15 * kPalm * std::sin(40 * t); };
  EXPECT_EQ(commands(Sign::Open, trembles), 1);
  EXPECT_EQ(commands(Sign::ThumbUp, trembles), 1);
  EXPECT_EQ(commands(Sign::None, trembles), 0);
}

TEST(HandCommand, is_no_wave) {
  for (const double rate : {0.8, 1.5, 3.0})
    EXPECT_EQ(
        commands(Sign::Open,
                 [&](double t) { return 2 * kPalm * std::sin(2 * std::numbers::pi * rate * t); }),
        0)
        << rate;
}

TEST(HandCommand, is_no_hand_that_passes_by) {
  EXPECT_EQ(commands(Sign::Open, [](double t) { return 0.1 * t; }), 0);
}

TEST(HandCommand, needs_a_hand_that_is_seen_all_the_time) {
  HandCommand command;
  for (int i = 0; i < 20; ++i)
    EXPECT_FALSE(
        command.update(hc::Time(1'700'000'000s) + i * 300ms, Sign::Open, {1, 0, 0}, kPalm));
}

TEST(HandCommand, comes_when_a_wave_ends) {
  EXPECT_EQ(commands(Sign::Open, [](double t) { return t < 1 ? 0.2 * t : 0.2; }), 1);
}

}  // namespace
