// SPDX-License-Identifier: Apache-2.0
#include <graph/log_limit.h>

#include <gtest/gtest.h>

namespace hc::internal {
namespace {

using namespace std::chrono_literals;

TEST(LogLimit, CountsWhatIsTooMuchInASecond) {
  LogLimit limit;
  for (std::uint64_t i = 0; i < LogLimit::kMostLines; ++i) ASSERT_TRUE(limit.passes(10, 0s));
  EXPECT_FALSE(limit.is_over());
  EXPECT_EQ(limit.take_remark(10s), "");
  for (int i = 0; i < 7; ++i) EXPECT_FALSE(limit.passes(10, 900ms));
  EXPECT_TRUE(limit.is_over());
  EXPECT_EQ(limit.take_remark(999ms), "");
  EXPECT_EQ(limit.take_remark(1s),
            "7 lines dropped in 1 s: more than 256 kB or 10000 lines in a second");
  EXPECT_TRUE(limit.passes(10, 1s));
}

TEST(LogLimit, CountsBytesToo) {
  LogLimit limit;
  EXPECT_TRUE(limit.passes(LogLimit::kMostBytes, 5s));
  EXPECT_FALSE(limit.passes(1, 5s));
}

TEST(LogLimit, WhoSaysLittleIsNeverLimited) {
  LogLimit limit;
  for (int second = 0; second < 100; ++second)
    for (int line = 0; line < 1000; ++line)
      ASSERT_TRUE(limit.passes(100, second * 1000ms + line * 1ms));
}

}  // namespace
}  // namespace hc::internal
