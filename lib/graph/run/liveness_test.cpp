// SPDX-License-Identifier: Apache-2.0
#include <graph/run/liveness.h>

#include <gtest/gtest.h>

namespace hc::internal {
namespace {

using namespace std::chrono_literals;

TEST(Liveness, IsSilentSinceTheLastReport) {
  Liveness liveness;
  liveness.check(true, 10s);
  liveness.check(true, 10500ms);
  EXPECT_EQ(liveness.silence(), 500ms);
  EXPECT_FALSE(liveness.has_reported());
  liveness.reported(false, 11s);
  EXPECT_EQ(liveness.silence(), 0s);
  EXPECT_EQ(liveness.since_report(13s), 2s);
}

TEST(Liveness, CountsALongGapBetweenChecksAsASecond) {
  Liveness liveness;
  liveness.check(true, 10s);
  liveness.check(true, 60s);
  EXPECT_EQ(liveness.silence(), 1s);
}

TEST(Liveness, IsNotSilentWithoutAProcess) {
  Liveness liveness;
  liveness.check(true, 10s);
  liveness.check(false, 11s);
  EXPECT_EQ(liveness.silence(), 0s);
}

TEST(Liveness, WaitsForAReaderSinceTheFirstReportOfIt) {
  Liveness liveness;
  liveness.reported(true, 10s);
  liveness.reported(true, 12s);
  EXPECT_EQ(liveness.blocked_since(), MonotonicTime(10s));
  liveness.reported(false, 13s);
  EXPECT_FALSE(liveness.blocked_since());
}

TEST(Liveness, ForgetsAProcessButNotItsLastCheck) {
  Liveness liveness;
  liveness.check(true, 10s);
  liveness.reported(true, 10s);
  liveness.forget();
  EXPECT_FALSE(liveness.has_reported() || liveness.blocked_since());
  liveness.check(true, 11s);
  EXPECT_EQ(liveness.silence(), 1s);
}

TEST(ProcessorMeter, GivesTheShareBetweenTheLastTwoMeasurements) {
  ProcessorMeter meter;
  meter.measure({.processor = 5s}, 10s);
  EXPECT_EQ(meter.processor(), 0);
  meter.measure({.processor = 6s}, 14s);
  EXPECT_DOUBLE_EQ(meter.processor(), 0.25);
  meter.measure({.processor = 4s}, 15s);  // a child has ended
  EXPECT_EQ(meter.processor(), 0);
}

}  // namespace
}  // namespace hc::internal
