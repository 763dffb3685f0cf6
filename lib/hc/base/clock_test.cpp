// SPDX-License-Identifier: Apache-2.0
#include <hc/base/clock.h>

#include <limits>
#include <type_traits>

#include <gtest/gtest.h>

namespace hc::internal {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::nanoseconds kDay = 24h;

// A time is neither a number nor a duration, and a difference of times is no time.
static_assert(!std::is_convertible_v<std::int64_t, Time>);
static_assert(!std::is_convertible_v<std::chrono::nanoseconds, Time>);
static_assert(!std::is_convertible_v<Time, std::int64_t>);
static_assert(std::is_same_v<decltype(Time() - Time()), std::chrono::nanoseconds>);

TEST(Time, IsNanosecondsSinceTheUnixEpoch) {
  using std::chrono::sys_days, std::chrono::November;
  EXPECT_EQ(unix_time(1'763'683'200'000'000'007), sys_days(2025y / November / 21) + 7ns);
  for (std::int64_t each :
       {std::int64_t{0}, std::int64_t{1}, std::int64_t{-1},
        std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()})
    EXPECT_EQ(unix_nanoseconds(unix_time(each)), each);
  EXPECT_EQ(unix_time(0), Time());
  EXPECT_EQ(later(unix_time(1), 2ns), unix_time(3));
  EXPECT_EQ(later(unix_time(1), std::chrono::nanoseconds::max()), Time::max());
  EXPECT_EQ(seconds(unix_time(2'500'000'000) - unix_time(1'000'000'000)), 1.5);
}

TEST(DistantWall, IsTheMonotonicClockPlusWhatIsSet) {
  DistantWall wall;
  EXPECT_FALSE(wall.is_set());
  wall.set(kDay, 5s);
  EXPECT_TRUE(wall.is_set());
  EXPECT_EQ(wall.wall(5s), Time(kDay + 5s));
  EXPECT_EQ(wall.wall(7s), Time(kDay + 7s));
}

TEST(DistantWall, MakesUpForALittleSlowlyAndNeverGoesBack) {
  for (const auto to_wall : {kDay + 3ms, kDay - 3ms}) {
    DistantWall wall;
    wall.set(kDay, 0s);
    wall.set(to_wall, 10s);
    Time before = wall.wall(10s);
    EXPECT_EQ(before, Time(kDay + 10s));
    for (int i = 1; i <= 40; ++i) {
      const auto time = wall.wall(10s + i * 100ms);
      EXPECT_LE(std::chrono::abs(time - before - 100ms), 100us + 1ns);
      before = time;
    }
    EXPECT_EQ(before, Time(to_wall + 14s));
  }
}

TEST(DistantWall, FollowsAStepAtOnce) {
  DistantWall wall;
  wall.set(kDay, 0s);
  wall.set(2 * kDay, 1s);
  EXPECT_EQ(wall.wall(1s), Time(2 * kDay + 1s));
}

TEST(DistantWall, DoesNotOverflow) {
  DistantWall wall;
  wall.set(std::chrono::nanoseconds::min(), 1s);
  EXPECT_EQ(wall.wall(1s), Time());
  wall.set(std::chrono::nanoseconds::max(), 2s);
  EXPECT_GT(wall.wall(2s), std::chrono::sys_days(std::chrono::year(2096) / 1 / 1));
  wall.set(std::chrono::nanoseconds::min(), 3s);
  EXPECT_EQ(wall.wall(3s), Time());
}

}  // namespace
}  // namespace hc::internal
