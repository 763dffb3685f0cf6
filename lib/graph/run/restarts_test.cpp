// SPDX-License-Identifier: Apache-2.0
#include <graph/run/restarts.h>

#include <tuple>

#include <gtest/gtest.h>

namespace hc::internal {
namespace {

using namespace std::chrono_literals;
using Next = Restarts::Next;

/// Starts and ends a module, with a simulated clock.
class RestartsTest : public ::testing::Test {
 protected:
  /// Runs once for this time.
  Restarts::Decision run(Restarts& restarts, std::chrono::nanoseconds time, int status = 1) {
    restarts.started(now_);
    now_ += time;
    auto decision = restarts.ended(status, now_);
    now_ += decision.delay;
    return decision;
  }

  MonotonicTime now_{5s};
};

TEST_F(RestartsTest, StatusAndPolicyDecide) {
  for (auto [policy, status, next] : {std::tuple(Restart::Never, 0, Next::End),
                                      {Restart::Never, 1, Next::GiveUp},
                                      {Restart::Failure, 0, Next::End},
                                      {Restart::Failure, 1, Next::Again},
                                      {Restart::Failure, 2, Next::GiveUp},
                                      {Restart::Failure, 137, Next::Again},
                                      {Restart::Always, 0, Next::Again},
                                      {Restart::Always, 2, Next::GiveUp}}) {
    Restarts restarts(policy, {}, 1);
    EXPECT_EQ(run(restarts, 1s, status).next, next) << static_cast<int>(policy) << " " << status;
  }
}

TEST_F(RestartsTest, FiveAtOnceThenDelayedThenGivenUp) {
  Restarts restarts(Restart::Failure, {}, 1);
  for (int start = 1; start < 5; ++start) {
    auto decision = run(restarts, 1ms);
    EXPECT_EQ(decision.next, Next::Again);
    EXPECT_EQ(decision.delay, 0s) << start;
  }
  auto whole = 100ms;
  for (int start = 0; start < 8; ++start) {
    auto decision = run(restarts, 1ms);
    ASSERT_EQ(decision.next, Next::Again) << start;
    EXPECT_GE(decision.delay, whole / 2);
    EXPECT_LE(decision.delay, whole);
    whole *= 2;
  }
  EXPECT_EQ(run(restarts, 1ms).next, Next::GiveUp);
}

TEST_F(RestartsTest, WhatIsLostWithItsHostHasNotFailed) {
  Restarts restarts(Restart::Failure, {}, 1);
  const auto lose = [&] {
    restarts.started(now_);
    return restarts.lost(now_);
  };
  for (int failures = 1; failures <= 4; ++failures) {
    for (int i = 0; i < 100; ++i) EXPECT_EQ(lose().next, Next::Again);
    const auto decision = run(restarts, 1ms);
    EXPECT_EQ(decision.next, Next::Again);
    EXPECT_EQ(decision.delay, 0s);
  }
  EXPECT_GT(run(restarts, 1ms).delay, 0s);
  EXPECT_EQ(lose().delay, 0s);
  EXPECT_GT(run(restarts, 1ms).delay, 0s);
  Restarts once(Restart::Never, {}, 1);
  once.started(now_);
  EXPECT_EQ(once.lost(now_).next, Next::GiveUp);
}

TEST_F(RestartsTest, ALongRunThatIsLostWithItsHostResetsTheCount) {
  const RestartLimits limits;
  Restarts restarts(Restart::Failure, limits, 1);
  while (run(restarts, 1ms).delay == 0s) {
  }
  for (int i = 1; i < limits.delayed_starts; ++i) EXPECT_EQ(run(restarts, 1ms).next, Next::Again);
  restarts.started(now_);
  now_ += limits.window + 1s;
  EXPECT_EQ(restarts.lost(now_).next, Next::Again);
  const auto decision = run(restarts, 1ms);
  EXPECT_EQ(decision.next, Next::Again);
  EXPECT_EQ(decision.delay, 0s);
}

TEST_F(RestartsTest, DelaysStayBelowTheLongest) {
  Restarts restarts(Restart::Failure, {.starts_at_once = 1, .delayed_starts = 100}, 1);
  for (int start = 0; start < 100; ++start) EXPECT_LE(run(restarts, 0s).delay, 30s);
  EXPECT_EQ(run(restarts, 0s).next, Next::GiveUp);
}

TEST_F(RestartsTest, ALongRunMakesAllForgotten) {
  Restarts restarts(Restart::Failure, {}, 1);
  for (int start = 0; start < 12; ++start) run(restarts, 1ms);
  EXPECT_EQ(run(restarts, 10s).delay, 0s);
  EXPECT_EQ(run(restarts, 1ms).delay, 0s);
}

TEST_F(RestartsTest, SlowFailuresAreNeverPutOff) {
  Restarts restarts(Restart::Failure, {}, 1);
  for (int start = 0; start < 100; ++start) EXPECT_EQ(run(restarts, 2500ms).delay, 0s);
}

}  // namespace
}  // namespace hc::internal
