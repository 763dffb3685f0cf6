// SPDX-License-Identifier: Apache-2.0
#include <hc/base/backoff.h>

#include <gtest/gtest.h>

#include <hc/base/clock.h>

namespace {

using std::chrono_literals::operator""ms;

TEST(Backoff, DoublesUpToTheLongestPause) {
  hc::Backoff backoff;
  EXPECT_TRUE(backoff.is_due(0ms));
  hc::MonotonicTime now = 1000ms;
  for (auto pause : {100ms, 200ms, 400ms, 800ms, 1600ms, 2000ms, 2000ms}) {
    backoff.fail(now);
    EXPECT_EQ(backoff.due(), now + pause);
    EXPECT_FALSE(backoff.is_due(now + pause - 1ms));
    now += pause;
    EXPECT_TRUE(backoff.is_due(now));
  }
}

TEST(Backoff, StartsOverAfterASuccess) {
  hc::Backoff backoff(10ms, 1000ms);
  backoff.fail(0ms);
  backoff.fail(10ms);
  backoff.reset();
  EXPECT_TRUE(backoff.is_due(11ms));
  backoff.fail(20ms);
  EXPECT_EQ(backoff.due(), 30ms);
}

}  // namespace
