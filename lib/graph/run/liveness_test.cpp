// SPDX-License-Identifier: Apache-2.0
#include <graph/run/liveness.h>

#include <gtest/gtest.h>

namespace hc::internal {
namespace {

using namespace std::chrono_literals;

/// Of a process that has never waited for a processor.
Usage idle() {
  return {};
}

TEST(Liveness, IsSilentSinceTheLastReport) {
  Liveness liveness;
  liveness.check(true, 10s, idle);
  liveness.check(true, 10500ms, idle);
  EXPECT_EQ(liveness.silence(), 500ms);
  EXPECT_FALSE(liveness.has_reported());
  liveness.reported(false, 11s);
  EXPECT_EQ(liveness.silence(), 0s);
}

TEST(Liveness, SaysWhatSilenceMeans) {
  Usage usage;
  const auto measure = [&] { return usage; };
  Liveness liveness;
  EXPECT_EQ(liveness.health(2s, 100s, measure), Health::Responsive) << "it may never report";
  usage.is_stopped = true;
  EXPECT_EQ(liveness.health(2s, 100s, measure), Health::Stopped);
  liveness.reported(false, 100s);
  EXPECT_EQ(liveness.health(2s, 101s, measure), Health::Responsive);
  EXPECT_EQ(liveness.health(2s, 102s, measure), Health::Stopped);
  usage.is_stopped = false;
  EXPECT_EQ(liveness.health(2s, 102s, measure), Health::Busy);
  liveness.reported(true, 102s);
  EXPECT_EQ(liveness.health(2s, 104s, measure), Health::Blocked);
  usage.is_stopped = true;
  EXPECT_EQ(liveness.health(2s, 104s, measure), Health::Stopped);
}

/// Silent for so many seconds, after its last report if it has sent one.
Liveness silent_for(int seconds, std::optional<bool> is_blocked) {
  Liveness liveness;
  liveness.check(true, 0s, idle);
  if (is_blocked) liveness.reported(*is_blocked, 0s);
  for (int time = 1; time <= seconds; ++time)
    liveness.check(true, std::chrono::seconds(time), idle);
  return liveness;
}

TEST(Liveness, HangsAfterItsTimeUnlessItIsDebuggedOrWaitsForAReader) {
  Usage usage;
  const auto hung = [&](const Liveness& liveness, MonotonicTime hang = 5s) {
    return liveness.hung_after(hang, std::nullopt, [&] { return usage; });
  };
  EXPECT_FALSE(hung(silent_for(4, false)));
  EXPECT_EQ(hung(silent_for(5, false)), MonotonicTime(5s));
  EXPECT_FALSE(hung(silent_for(5, false), 0s)) << "never";
  EXPECT_FALSE(hung(silent_for(9, true))) << "it waits for a reader";
  usage.is_stopped = true;
  EXPECT_EQ(hung(silent_for(5, true)), MonotonicTime(5s));
  usage.is_traced = true;
  EXPECT_FALSE(hung(silent_for(9, false)));
}

TEST(Liveness, HasMoreTimeForItsFirstReport) {
  Usage usage;
  const auto hung = [&](int seconds, std::optional<MonotonicTime> first) {
    return silent_for(seconds, {}).hung_after(5s, first, [&] { return usage; });
  };
  EXPECT_FALSE(hung(90, {})) << "it may never report";
  EXPECT_FALSE(hung(59, 60s));
  EXPECT_EQ(hung(60, 60s), MonotonicTime(60s));
  EXPECT_EQ(hung(5, 1s), MonotonicTime(5s));
  usage.is_stopped = true;
  EXPECT_EQ(hung(5, 60s), MonotonicTime(5s));
}

TEST(Liveness, CountsALongGapBetweenChecksAsASecond) {
  Liveness liveness;
  liveness.check(true, 10s, idle);
  liveness.check(true, 60s, idle);
  EXPECT_EQ(liveness.silence(), 1s);
}

TEST(Liveness, IsNotSilentWhileItWaitsForAProcessor) {
  Liveness liveness;
  Usage usage;
  const auto measure = [&] { return usage; };
  for (auto time = 0s; time <= 2s; time += 1s) liveness.check(true, time, measure);
  EXPECT_EQ(liveness.silence(), 2s);
  usage.waited = 900ms;
  liveness.check(true, 3s, measure);
  EXPECT_EQ(liveness.silence(), 2100ms);
  usage.waited = 9s;  // also before it was looked at
  liveness.check(true, 4s, measure);
  EXPECT_EQ(liveness.silence(), 2100ms);
  liveness.check(true, 5s, measure);
  EXPECT_EQ(liveness.silence(), 3100ms);
}

TEST(Liveness, IsNotSilentWhileItWaitsOnAnotherHost) {
  Liveness liveness;
  Usage usage;
  const auto measure = [&] { return usage; };
  for (auto time = 0ms; time <= 20s; time += 250ms) {
    usage.waited = std::chrono::floor<std::chrono::seconds>(time);  // it says so once a second
    liveness.check(true, time, measure);
    EXPECT_LE(liveness.silence(), 3s) << time.count();
  }
}

TEST(Liveness, ForgetsHowLongItHasWaitedWhenItReports) {
  Liveness liveness;
  Usage usage;
  const auto measure = [&] { return usage; };
  for (auto time = 0s; time <= 2s; time += 1s) liveness.check(true, time, measure);
  liveness.reported(false, 2s);
  usage.waited = 5s;
  for (auto time = 3s; time <= 5s; time += 1s) liveness.check(true, time, measure);
  EXPECT_EQ(liveness.silence(), 3s);
}

TEST(Liveness, IsNotSilentWithoutAProcess) {
  Liveness liveness;
  liveness.check(true, 10s, idle);
  liveness.check(false, 11s, idle);
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
  liveness.check(true, 10s, idle);
  liveness.reported(true, 10s);
  liveness.forget();
  EXPECT_FALSE(liveness.has_reported() || liveness.blocked_since());
  liveness.check(true, 11s, idle);
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
