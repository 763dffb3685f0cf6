// SPDX-License-Identifier: Apache-2.0
#include "pairing.h"

#include <chrono>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace {

hc::Time time_of(std::int64_t milliseconds) {
  return hc::Time(std::chrono::milliseconds(milliseconds));
}
std::int64_t milliseconds_of(hc::Time time) {
  return time.time_since_epoch() / std::chrono::milliseconds(1);
}

/// The times [ms] of all pairs from images that arrive in order of time.
std::vector<std::pair<std::int64_t, std::int64_t>> pairs_of(std::vector<std::int64_t> left,
                                                            std::vector<std::int64_t> right) {
  Pairing pairing;
  std::vector<std::pair<std::int64_t, std::int64_t>> pairs;
  for (std::size_t l = 0, r = 0; l < left.size() || r < right.size();) {
    if (r == right.size() || (l < left.size() && left[l] <= right[r]))
      pairing.add(0, {{}, time_of(left[l++])});
    else
      pairing.add(1, {{}, time_of(right[r++])});
    while (auto pair = pairing.take())
      pairs.emplace_back(milliseconds_of((*pair)[0].time), milliseconds_of((*pair)[1].time));
  }
  return pairs;
}

using Matched = std::vector<std::pair<std::int64_t, std::int64_t>>;

TEST(Pairing, equal_times_at_once) {
  EXPECT_EQ(pairs_of({20, 40}, {20, 40}), (Matched{{20, 20}, {40, 40}}));
}

TEST(Pairing, the_nearest_of_cameras_that_are_out_of_step) {
  // Right is 5 ms late; no pairs before the first period is known.
  const auto pairs = pairs_of({20, 40, 60, 80, 100}, {25, 45, 65, 85, 105});
  ASSERT_GE(pairs.size(), 3U);
  for (const auto& [left, right] : pairs) EXPECT_EQ(right - left, 5);
}

TEST(Pairing, a_late_left_one_is_paired_with_the_nearer_right_one) {
  const auto pairs = pairs_of({20, 40, 60, 80, 100, 120}, {35, 55, 75, 95, 115});
  ASSERT_GE(pairs.size(), 3U);
  for (const auto& [left, right] : pairs) EXPECT_EQ(left - right, 5);
}

TEST(Pairing, a_faster_camera_is_thinned_out) {
  const auto pairs = pairs_of({100, 110, 120, 130, 140, 150, 160, 170, 180}, {100, 132, 164});
  EXPECT_EQ(pairs, (Matched{{100, 100}, {130, 132}, {160, 164}}));
}

TEST(Pairing, an_image_that_is_missing_costs_one_pair) {
  const auto pairs = pairs_of({20, 40, 60, 80, 100, 120}, {20, 40, 80, 100, 120});
  EXPECT_EQ(pairs, (Matched{{20, 20}, {40, 40}, {80, 80}, {100, 100}, {120, 120}}));
}

TEST(Pairing, a_clock_that_goes_back_starts_over) {
  EXPECT_EQ(pairs_of({}, {}), Matched{});
  Pairing pairing;
  pairing.add(0, {{}, time_of(100)});
  pairing.add(0, {{}, time_of(10)});
  pairing.add(1, {{}, time_of(10)});
  const auto pair = pairing.take();
  ASSERT_TRUE(pair);
  EXPECT_EQ((*pair)[0].time, time_of(10));
}

TEST(Pairing, times_in_bursts_have_a_period) {
  // Images of 20 ms, three at a time.
  const std::vector<std::int64_t> times{60,  60,  60,  120, 120, 120, 180, 180,
                                        180, 240, 240, 240, 300, 300, 300};
  std::vector<std::int64_t> later;
  for (const auto time : times) later.push_back(time + 5);
  const auto pairs = pairs_of(times, later);
  EXPECT_GE(pairs.size(), 10U);
  for (const auto& [left, right] : pairs) EXPECT_EQ(right - left, 5);
}

TEST(Pairing, no_pairs_for_seconds_are_noticed) {
  Pairing pairing;
  const auto add_both = [&](std::int64_t left, std::int64_t right) {
    pairing.add(0, {{}, time_of(left)});
    pairing.add(1, {{}, time_of(right)});
    return pairing.take().has_value();
  };
  for (int i = 0; i < 60; ++i) {
    EXPECT_FALSE(add_both(1000 + 50 * i, 90'000 + 50 * i));
    EXPECT_FALSE(pairing.starves_by());
  }
  EXPECT_FALSE(add_both(4000, 93'000));
  EXPECT_EQ(pairing.starves_by(), std::chrono::seconds(89));
  EXPECT_TRUE(add_both(93'010, 93'010));
  EXPECT_FALSE(pairing.starves_by());
}

TEST(Pairing, an_eye_that_is_silent_is_no_lack_of_pairs) {
  Pairing pairing;
  for (int i = 0; i < 200; ++i) {
    pairing.add(0, {{}, time_of(1000 + 50 * i)});
    EXPECT_FALSE(pairing.take());
    EXPECT_FALSE(pairing.starves_by());
  }
}

}  // namespace
