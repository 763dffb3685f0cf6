// SPDX-License-Identifier: Apache-2.0
#include <hosts/clock_estimate.h>

#include <random>

#include <gtest/gtest.h>

namespace hc::hosts {
namespace {

using std::chrono::nanoseconds;
using namespace std::chrono_literals;

/// A clock that is an hour ahead and faster by `drift`.
MonotonicTime there(MonotonicTime here, double drift) {
  return here + 1h + duration(drift * seconds(here));
}

Exchange exchange(MonotonicTime at, nanoseconds out, nanoseconds back, double drift = 0) {
  return {at, there(at + out, drift), there(at + out, drift) + 1ms, at + out + 1ms + back};
}

TEST(ClockEstimate, TheExchangeWithTheShortestDelayCounts) {
  ClockEstimate estimate;
  EXPECT_FALSE(estimate.is_known());
  estimate.add(exchange(0s, 30ms, 1ms));
  EXPECT_NE(estimate.offset(0s), 1h);
  EXPECT_LE(std::chrono::abs(estimate.offset(0s) - 1h), estimate.error(0s));
  estimate.add(exchange(500ms, 1ms, 1ms));
  estimate.add(exchange(1s, 1ms, 40ms));
  EXPECT_EQ(estimate.offset(1s), 1h);
  EXPECT_EQ(estimate.delay(), 2ms);
  EXPECT_GE(estimate.error(1s), 1ms);
  EXPECT_FALSE(estimate.drift());
}

TEST(ClockEstimate, OneThatIsOlderThanEightIsForgotten) {
  ClockEstimate estimate;
  estimate.add(exchange(0s, 0s, 0s));
  for (int i = 1; i <= 8; ++i) estimate.add(exchange(i * 500ms, 10ms, 10ms));
  EXPECT_EQ(estimate.delay(), 20ms);
}

TEST(ClockEstimate, TheDriftIsFittedAndTheErrorBoundsWhatIsWrong) {
  ClockEstimate estimate;
  constexpr double kDrift = 100e-6;
  std::mt19937 random(7);
  std::exponential_distribution<double> late(1 / 2e-3);  // on average 2 ms each way [s]
  MonotonicTime now{0};
  for (int i = 0; i < 240; ++i, now += 500ms) {
    estimate.add(
        exchange(now, 200us + duration(late(random)), 200us + duration(late(random)), kDrift));
    const auto wrong = std::chrono::abs(estimate.offset(now) - (there(now, kDrift) - now));
    ASSERT_LE(wrong, estimate.error(now)) << i;
    if (i > 60) {
      ASSERT_LT(wrong, 1ms) << i;
    }
  }
  ASSERT_TRUE(estimate.drift());
  EXPECT_NEAR(*estimate.drift(), kDrift, 20e-6);
}

TEST(ClockEstimate, WhatTookLongIsNotTakenForADrift) {
  ClockEstimate estimate;
  MonotonicTime now{0};
  // A machine that is busy at first: each request is late.
  for (nanoseconds late = 4ms; now < 40s; now += 500ms, late = late * 3 / 4) {
    estimate.add(exchange(now, 100us + late, 100us, 100e-6));
    if (estimate.drift()) {
      ASSERT_NEAR(*estimate.drift(), 100e-6, 75e-6) << seconds(now);  // unweighted, 200e-6
    }
    ASSERT_LE(std::chrono::abs(estimate.offset(now) - (there(now, 100e-6) - now)),
              estimate.error(now));
  }
  EXPECT_TRUE(estimate.drift());
}

TEST(ClockEstimate, DoesNotOverflow) {
  constexpr auto kLeast = MonotonicTime::min(), kMost = MonotonicTime::max();
  ClockEstimate estimate;
  for (auto asked : {kLeast, kMost, 1ns})
    for (auto taken : {kLeast, kMost, 1ns})
      for (auto answered : {kLeast, kMost, 1ns}) estimate.add({asked, taken, answered, 5s});
  EXPECT_LE(std::chrono::abs(estimate.offset(6s)), 2 * kMostApart);
}

}  // namespace
}  // namespace hc::hosts
