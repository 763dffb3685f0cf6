// SPDX-License-Identifier: Apache-2.0
#include <hosts/clock_estimate.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

namespace hc::hosts {
namespace {

constexpr std::int64_t kMs = 1'000'000, kHour = 3600'000 * kMs;

/// A clock that is an hour ahead and faster by `drift`.
std::int64_t there(std::int64_t here, double drift) {
  return here + kHour + static_cast<std::int64_t>(drift * static_cast<double>(here));
}

Exchange exchange(std::int64_t at, std::int64_t out, std::int64_t back, double drift = 0) {
  return {at, there(at + out, drift), there(at + out, drift) + kMs, at + out + kMs + back};
}

TEST(ClockEstimate, TheExchangeWithTheShortestDelayCounts) {
  ClockEstimate estimate;
  EXPECT_FALSE(estimate.is_known());
  estimate.add(exchange(0, 30 * kMs, kMs));
  EXPECT_NE(estimate.offset(0), kHour);
  EXPECT_LE(std::abs(estimate.offset(0) - kHour), estimate.error(0));
  estimate.add(exchange(500 * kMs, kMs, kMs));
  estimate.add(exchange(1000 * kMs, kMs, 40 * kMs));
  EXPECT_EQ(estimate.offset(1000 * kMs), kHour);
  EXPECT_EQ(estimate.delay(), 2 * kMs);
  EXPECT_GE(estimate.error(1000 * kMs), kMs);
  EXPECT_FALSE(estimate.drift());
}

TEST(ClockEstimate, OneThatIsOlderThanEightIsForgotten) {
  ClockEstimate estimate;
  estimate.add(exchange(0, 0, 0));
  for (int i = 1; i <= 8; ++i) estimate.add(exchange(i * 500 * kMs, 10 * kMs, 10 * kMs));
  EXPECT_EQ(estimate.delay(), 20 * kMs);
}

TEST(ClockEstimate, TheDriftIsFittedAndTheErrorBoundsWhatIsWrong) {
  ClockEstimate estimate;
  constexpr double kDrift = 100e-6;
  std::mt19937 random(7);
  std::exponential_distribution<double> late(1 / 2e6);  // on average 2 ms each way
  std::int64_t now = 0;
  for (int i = 0; i < 240; ++i, now += 500 * kMs) {
    estimate.add(exchange(now, kMs / 5 + static_cast<std::int64_t>(late(random)),
                          kMs / 5 + static_cast<std::int64_t>(late(random)), kDrift));
    const std::int64_t wrong = std::abs(estimate.offset(now) - (there(now, kDrift) - now));
    ASSERT_LE(wrong, estimate.error(now)) << i;
    if (i > 60) {
      ASSERT_LT(wrong, kMs) << i;
    }
  }
  ASSERT_TRUE(estimate.drift());
  EXPECT_NEAR(*estimate.drift(), kDrift, 20e-6);
}

TEST(ClockEstimate, WhatTookLongIsNotTakenForADrift) {
  ClockEstimate estimate;
  std::int64_t now = 0;
  // A machine that is busy at first: each request is late.
  for (std::int64_t late = 4 * kMs; now < 40'000 * kMs; now += 500 * kMs, late = late * 3 / 4) {
    estimate.add(exchange(now, kMs / 10 + late, kMs / 10, 100e-6));
    if (estimate.drift()) {
      ASSERT_NEAR(*estimate.drift(), 100e-6, 75e-6) << now;  // unweighted, 200e-6
    }
    ASSERT_LE(std::abs(estimate.offset(now) - (there(now, 100e-6) - now)), estimate.error(now));
  }
  EXPECT_TRUE(estimate.drift());
}

}  // namespace
}  // namespace hc::hosts
