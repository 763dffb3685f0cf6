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

}  // namespace
