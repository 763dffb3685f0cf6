// SPDX-License-Identifier: Apache-2.0
#include <hc/base/clock.h>

#include <gtest/gtest.h>

namespace hc::internal {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kDay = 86'400'000'000'000, kMs = 1'000'000;

TEST(DistantWall, IsTheMonotonicClockPlusWhatIsSet) {
  DistantWall wall;
  EXPECT_FALSE(wall.is_set());
  wall.set(kDay, 5s);
  EXPECT_TRUE(wall.is_set());
  EXPECT_EQ(wall.wall(5s), kDay + 5000 * kMs);
  EXPECT_EQ(wall.wall(7s), kDay + 7000 * kMs);
}

TEST(DistantWall, MakesUpForALittleSlowlyAndNeverGoesBack) {
  for (const std::int64_t to_wall : {kDay + 3 * kMs, kDay - 3 * kMs}) {
    DistantWall wall;
    wall.set(kDay, 0s);
    wall.set(to_wall, 10s);
    std::int64_t before = wall.wall(10s);
    EXPECT_EQ(before, kDay + 10'000 * kMs);
    for (int i = 1; i <= 40; ++i) {
      const auto time = wall.wall(10s + i * 100ms);
      EXPECT_NEAR(static_cast<double>(time - before), 100e6, 0.1e6 + 1);
      before = time;
    }
    EXPECT_EQ(before, to_wall + 14'000 * kMs);
  }
}

TEST(DistantWall, FollowsAStepAtOnce) {
  DistantWall wall;
  wall.set(kDay, 0s);
  wall.set(2 * kDay, 1s);
  EXPECT_EQ(wall.wall(1s), 2 * kDay + 1000 * kMs);
}

}  // namespace
}  // namespace hc::internal
