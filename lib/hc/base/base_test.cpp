// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <hc/base/clock.h>
#include <hc/base/result.h>

namespace hc {
namespace {

Result<int> half(int value) {
  if (value % 2 != 0) return Error{Code::Invalid, std::to_string(value) + " is odd"};
  return value / 2;
}

TEST(Result, HoldsAValueOrAnError) {
  auto good = half(4);
  ASSERT_TRUE(good);
  EXPECT_EQ(*good, 2);
  EXPECT_EQ(good.value_or(7), 2);
  auto failed = half(3);
  ASSERT_FALSE(failed.has_value());
  EXPECT_EQ(failed.error().text(), "Invalid: 3 is odd");
  EXPECT_EQ(failed.value_or(7), 7);
}

TEST(Result, OfNothingIsASuccessByDefault) {
  Status good;
  EXPECT_TRUE(good);
  Status failed = Error{Code::Closed, "gone"};
  EXPECT_FALSE(failed);
  EXPECT_EQ(failed.error().code, Code::Closed);
}

TEST(ResultDeathTest, TheWrongSideIsABug) {
  EXPECT_DEATH(static_cast<void>(half(3).value()), "check failed.*3 is odd");
  EXPECT_DEATH(static_cast<void>(half(4).error()), "check failed");
  EXPECT_DEATH(static_cast<void>(Status().error()), "check failed");
}

TEST(Code, HasANameEach) {
  const std::pair<Code, const char*> names[] = {
      {Code::Malformed, "Malformed"}, {Code::Unsupported, "Unsupported"},
      {Code::TooLarge, "TooLarge"},   {Code::Truncated, "Truncated"},
      {Code::Closed, "Closed"},       {Code::NotFound, "NotFound"},
      {Code::Invalid, "Invalid"},     {Code::System, "System"}};
  for (const auto& [code, text] : names) EXPECT_EQ(name(code), text);
}

TEST(Clock, OnlyHandsMoveAManualOne) {
  ManualClock clock;
  clock.set_wall(unix_time(1000));
  clock.advance(std::chrono::nanoseconds(50));
  EXPECT_EQ(clock.wall(), unix_time(1050));
  EXPECT_EQ(clock.monotonic(), MonotonicTime(50));
}

TEST(Clock, SecondsAndBack) {
  EXPECT_EQ(seconds(std::chrono::milliseconds(250)), 0.25);
  EXPECT_EQ(duration(0.25), std::chrono::milliseconds(250));
  EXPECT_EQ(duration(0.0 / 0.0).count(), 0);
  EXPECT_GT(duration(1e300), std::chrono::hours(24 * 365 * 290));
}

TEST(Clock, TheSystemsMonotonicOneNeverGoesBack) {
  SystemClock clock;
  auto before = clock.monotonic();
  EXPECT_LE(before, clock.monotonic());
  EXPECT_GT(clock.wall(), unix_time(1'700'000'000'000'000'000));
}

}  // namespace
}  // namespace hc
