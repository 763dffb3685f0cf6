// SPDX-License-Identifier: Apache-2.0
#include <hc/module/period.h>

#include <gtest/gtest.h>

#include <limits>

namespace hc::internal {
namespace {

using namespace std::chrono_literals;

TEST(Period, IsOneByTheRate) {
  EXPECT_EQ(period_of(20), 50ms);
  EXPECT_EQ(period_of(1e-3), 1000s);
  EXPECT_EQ(period_of(1e12), 0ns);
}

TEST(Period, HasALongest) {
  using Limits = std::numeric_limits<double>;
  for (double rate : {1e-10, Limits::denorm_min(), 0.0, -0.0, -5.0, Limits::infinity(),
                      -Limits::infinity(), Limits::quiet_NaN()})
    EXPECT_EQ(period_of(rate), kLongestPeriod) << rate;
}

}  // namespace
}  // namespace hc::internal
