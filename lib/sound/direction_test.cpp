// SPDX-License-Identifier: Apache-2.0
#include <sound/direction.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace hc::audio {
namespace {

constexpr int kRate = 16000;
constexpr double kBase = 0.18;

/// A chirp from a direction, as received by two ears.
std::vector<std::int16_t> from(double pan, double loudness, double noise = 0) {
  std::mt19937 random(4);
  std::normal_distribution<double> hiss(0, noise + 1e-9);
  std::vector<std::int16_t> stereo;
  for (int i = 0; i < 800; ++i)
    for (double side : {1.0, -1.0}) {  // left, right
      const double t = i / double{kRate} + side * kBase / 2 * std::sin(pan) / 343;
      const double wave = std::sin(2 * std::numbers::pi * (500 * t + 5000 * t * t));
      stereo.push_back(static_cast<std::int16_t>(std::lround(loudness * wave + hiss(random))));
    }
  return stereo;
}

TEST(Direction, from_the_left_is_over_0_from_the_right_below) {
  for (double degrees : {-80.0, -40.0, -10.0, 0.0, 5.0, 30.0, 60.0}) {
    const double pan = degrees * std::numbers::pi / 180;
    const auto heard = hear(from(pan, 8000, 200), kRate, kBase);
    ASSERT_TRUE(heard.pan) << degrees;
    EXPECT_NEAR(std::sin(*heard.pan), std::sin(pan), 0.03) << degrees;
  }
}

TEST(Direction, level_is_the_root_of_the_mean_square) {
  EXPECT_NEAR(hear(from(0, 16384), kRate, kBase).level, 0.5 / std::numbers::sqrt2, 0.005);
}

TEST(Direction, silence_noise_and_little_have_none) {
  EXPECT_FALSE(hear(std::vector<std::int16_t>(1600), kRate, kBase).pan);
  EXPECT_EQ(hear(std::vector<std::int16_t>(1600), kRate, kBase).level, 0);
  EXPECT_FALSE(hear(from(0.5, 0, 2000), kRate, kBase).pan);
  EXPECT_FALSE(hear({}, kRate, kBase).pan);
  EXPECT_FALSE(hear(std::vector<std::int16_t>(20, 1000), kRate, kBase).pan);
  EXPECT_FALSE(hear(from(0.5, 8000), 0, kBase).pan);
  EXPECT_FALSE(hear(from(0.5, 8000), kRate, 0).pan);
}

}  // namespace
}  // namespace hc::audio
