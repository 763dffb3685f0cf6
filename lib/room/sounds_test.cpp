// SPDX-License-Identifier: Apache-2.0
#include <room/sounds.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace hc::room {

namespace {

std::vector<std::int16_t> heard(double distance) {
  std::vector<std::int16_t> samples(kSoundRate);
  hear(0, distance, chirps, samples, 1);
  return samples;
}

TEST(Sounds, are_later_and_weaker_from_farther_away) {
  const auto near = heard(1.0), far = heard(2.0);
  // 1 m takes 46.65 samples.
  long long best = 0;
  int shift = 0;
  for (int candidate = 0; candidate < 100; ++candidate) {
    long long sum = 0;
    for (std::size_t i = 0; i + 100 < near.size(); ++i)
      sum += near[i] * far[i + static_cast<std::size_t>(candidate)];
    if (sum > best) {
      best = sum;
      shift = candidate;
    }
  }
  EXPECT_EQ(shift, 47);
  auto peak = [](const std::vector<std::int16_t>& samples) {
    int most = 0;
    for (auto sample : samples) most = std::max(most, std::abs(sample));
    return most;
  };
  EXPECT_NEAR(peak(near), 2 * peak(far), 30);
}

TEST(Sounds, join_without_a_gap) {
  const auto whole = heard(1.5);
  std::vector<std::int16_t> parts(whole.size());
  hear(0, 1.5, chirps, std::span(parts).first(5000), 1);
  hear(5000, 1.5, chirps, std::span(parts).subspan(5000), 1);
  EXPECT_EQ(whole, parts);
}

TEST(Sounds, are_added_to_one_channel_of_two) {
  std::vector<std::int16_t> both(2 * 4000, 99);
  hear(0, 1, chirps, std::span(both).subspan(1), 2);
  EXPECT_EQ(both[0], 99);
  EXPECT_EQ(both[1000], 99);
  EXPECT_EQ(both[1], 99);
  const auto alone = heard(1);
  EXPECT_EQ(both[2 * 2000 + 1], 99 + alone[2000]);
}

TEST(Sounds, of_a_voice_repeat_with_its_pitch_and_pause_between_syllables) {
  EXPECT_EQ(voice(120, -1), 0);
  double most = 0, off = 0;
  for (double t = 0.1; t < 0.15; t += 1e-4) {
    most = std::max(most, std::abs(voice(100, t)));
    off = std::max(off, std::abs(voice(100, t) - voice(100, t + 0.01)));
  }
  EXPECT_GT(most, 0.3);
  EXPECT_LT(off, 0.25 * most);
  for (double t = 0.2435; t < 0.2443; t += 1e-4) EXPECT_LT(std::abs(voice(100, t)), 0.05);
}

}  // namespace

}  // namespace hc::room
