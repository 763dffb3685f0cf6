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
  hear(0, distance, samples, 1);
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
  hear(0, 1.5, std::span(parts).first(5000), 1);
  hear(5000, 1.5, std::span(parts).subspan(5000), 1);
  EXPECT_EQ(whole, parts);
}

TEST(Sounds, fill_one_channel_of_two) {
  std::vector<std::int16_t> both(2 * 4000, 99);
  hear(0, 1, std::span(both).subspan(1), 2);
  EXPECT_EQ(both[0], 99);
  EXPECT_EQ(both[1000], 99);
  EXPECT_EQ(both[1], 0);
}

}  // namespace

}  // namespace hc::room
