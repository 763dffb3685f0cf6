// SPDX-License-Identifier: Apache-2.0
#include <frames/track.h>

#include <gtest/gtest.h>

#include <iterator>
#include <map>

#include "random_motion_test.h"

namespace hc::frames {
namespace {

Pose at_x(double x) {
  Pose pose;
  pose.p.x() = x;
  return pose;
}

TEST(Track, IsLinearBetweenNeighbours) {
  Track track({});
  EXPECT_TRUE(track.empty());
  EXPECT_EQ(track.add(unix_time(1000), at_x(0)), Fed::Added);
  EXPECT_EQ(track.known(), (TimeSpan{unix_time(1000), unix_time(1000)}));
  EXPECT_EQ(track.at(unix_time(1000)).p.x(), 0);
  EXPECT_EQ(track.add(unix_time(2000), at_x(8)), Fed::Added);
  EXPECT_EQ(track.add(unix_time(1500), at_x(1)), Fed::Added)
      << "late, but within what is remembered";
  EXPECT_EQ(track.known(), (TimeSpan{unix_time(1000), unix_time(2000)}));
  EXPECT_EQ(track.at(unix_time(1250)).p.x(), 0.5);
  EXPECT_EQ(track.at(unix_time(1500)).p.x(), 1);
  EXPECT_EQ(track.at(unix_time(1750)).p.x(), 4.5);
}

TEST(Track, ARepeatedTimeReplaces) {
  Track track({});
  track.add(unix_time(1000), at_x(0));
  track.add(unix_time(2000), at_x(8));
  EXPECT_EQ(track.add(unix_time(2000), at_x(4)), Fed::Replaced);
  EXPECT_EQ(track.at(unix_time(1500)).p.x(), 2);
  EXPECT_EQ(track.add(unix_time(1000), at_x(2)), Fed::Replaced);
  EXPECT_EQ(track.at(unix_time(1500)).p.x(), 3);
  track.clear();
  EXPECT_TRUE(track.empty());
  EXPECT_EQ(track.add(unix_time(1), at_x(0)), Fed::Added) << "a clock that starts over";
}

TEST(Track, RemembersASpan) {
  Track track({.span = std::chrono::nanoseconds(100)});
  for (std::int64_t time : {1, 50, 101}) EXPECT_EQ(track.add(unix_time(time), at_x(0)), Fed::Added);
  EXPECT_EQ(track.known(), (TimeSpan{unix_time(1), unix_time(101)}));
  EXPECT_EQ(track.add(unix_time(102), at_x(0)), Fed::Added);
  EXPECT_EQ(track.known(), (TimeSpan{unix_time(50), unix_time(102)}));
  EXPECT_EQ(track.add(unix_time(1), at_x(0)), Fed::TooOld);
  EXPECT_EQ(track.add(unix_time(2), at_x(0)), Fed::Added);
  EXPECT_EQ(track.known(), (TimeSpan{unix_time(2), unix_time(102)}));
  EXPECT_EQ(track.add(unix_time(10'000), at_x(0)), Fed::Added);
  EXPECT_EQ(track.known(), (TimeSpan{unix_time(10'000), unix_time(10'000)}));
}

TEST(Track, RemembersACount) {
  Track track({.poses = 2});
  for (std::int64_t time : {10, 20, 30}) EXPECT_EQ(track.add(unix_time(time), at_x(0)), Fed::Added);
  EXPECT_EQ(track.known(), (TimeSpan{unix_time(20), unix_time(30)}));
  EXPECT_EQ(track.add(unix_time(15), at_x(0)), Fed::TooOld);
  EXPECT_EQ(track.add(unix_time(20), at_x(0)), Fed::Replaced);
  EXPECT_EQ(track.add(unix_time(25), at_x(0)), Fed::Added);
  EXPECT_EQ(track.known(), (TimeSpan{unix_time(25), unix_time(30)}));
}

TEST(Track, BearsTheFirstAndLastTimesThereAre) {
  Track track({.span = std::chrono::nanoseconds::max(), .gap = std::chrono::nanoseconds::max()});
  track.add(Time::max(), at_x(1));
  track.add(unix_time(1), at_x(0));
  EXPECT_EQ(track.known(), (TimeSpan{unix_time(1), Time::max()}));
  EXPECT_NEAR(track.at(unix_time(unix_nanoseconds(Time::max()) / 2)).p.x(), 0.5, 1e-15);
}

TEST(Track, IsWhatASortedListWouldBe) {
  RandomMotion random(6);
  for (int round = 0; round < 50; ++round) {
    const int span = random.whole(1, 200), count = random.whole(1, 40);
    const int gap = random.whole(1, 60);
    Track track({std::chrono::nanoseconds(span), static_cast<std::size_t>(count),
                 std::chrono::nanoseconds(gap)});
    std::map<std::int64_t, Pose> all;
    for (int i = 0; i < 100; ++i) {
      std::int64_t time = random.whole(1, 300);
      Pose pose(random.transformation());
      Fed fed = track.add(unix_time(time), pose);
      bool is_new = !all.contains(time);
      all[time] = pose;
      while (all.size() > static_cast<std::size_t>(count) ||
             all.rbegin()->first - all.begin()->first > span)
        all.erase(all.begin());
      ASSERT_EQ(fed, !all.contains(time) ? Fed::TooOld : is_new ? Fed::Added : Fed::Replaced);
      ASSERT_EQ(track.known(),
                (TimeSpan{unix_time(all.begin()->first), unix_time(all.rbegin()->first)}));
      std::int64_t asked =
          random.whole(static_cast<int>(all.begin()->first), static_cast<int>(all.rbegin()->first));
      auto next = all.lower_bound(asked), before = next == all.begin() ? next : std::prev(next);
      // Known backwards from each time, one by one.
      auto is_known = [&](std::int64_t at) {
        auto right = all.lower_bound(at);
        if (right == all.end() || right->first == at) return right != all.end();
        return right != all.begin() && right->first - std::prev(right)->first <= gap;
      };
      std::int64_t last = asked + random.whole(-20, 20);
      std::optional<TimeSpan> expected_span;
      auto until = track.known_until(unix_time(last));
      while (last >= all.begin()->first && !is_known(last)) --last;
      if (last >= all.begin()->first) {
        std::int64_t first = last;
        while (is_known(first - 1)) --first;
        expected_span = {unix_time(first), unix_time(last)};
      }
      ASSERT_EQ(until, expected_span);
      auto hole = track.gap_at(unix_time(asked));
      ASSERT_EQ(hole.has_value(), !is_known(asked));
      if (hole) {
        ASSERT_EQ(*hole, (TimeSpan{unix_time(before->first), unix_time(next->first)}));
        continue;
      }
      Eigen::Matrix4d expected = next->second.transformation().matrix();
      if (next->first != asked)
        expected = interpolated(before->second.transformation().matrix(), expected,
                                static_cast<double>(asked - before->first) /
                                    static_cast<double>(next->first - before->first));
      ASSERT_LT((track.at(unix_time(asked)).transformation().matrix() - expected).norm(), 1e-9);
    }
  }
}

TEST(Track, BridgesNoGap) {
  Track track({.gap = std::chrono::nanoseconds(100)});
  for (std::int64_t time : {100, 200, 301, 350})
    track.add(unix_time(time), at_x(static_cast<double>(time)));
  EXPECT_EQ(track.at(unix_time(150)).p.x(), 150) << "as far apart as is bridged";
  EXPECT_EQ(track.gap_at(unix_time(150)), std::nullopt);
  EXPECT_EQ(track.gap_at(unix_time(201)), (TimeSpan{unix_time(200), unix_time(301)}));
  for (std::int64_t time : {200, 301}) EXPECT_EQ(track.at(unix_time(time)).p.x(), time);
  EXPECT_EQ(track.known(), (TimeSpan{unix_time(100), unix_time(350)}));
  EXPECT_EQ(track.known_until(unix_time(1000)), (TimeSpan{unix_time(301), unix_time(350)}));
  EXPECT_EQ(track.known_until(unix_time(310)), (TimeSpan{unix_time(301), unix_time(310)}));
  EXPECT_EQ(track.known_until(unix_time(300)), (TimeSpan{unix_time(100), unix_time(200)}));
  EXPECT_EQ(track.known_until(unix_time(99)), std::nullopt);
  track.add(unix_time(260), at_x(0));
  EXPECT_EQ(track.gap_at(unix_time(201)), std::nullopt) << "a late pose closes it";
}

TEST(Track, TheNearestPoseIsThatOfWhatStandsStill) {
  Track track{Memory{}};
  using namespace std::chrono_literals;
  auto x = [&](std::chrono::nanoseconds time) { return track.nearest(Time(time)).p.x(); };
  for (int place : {1, 2, 5}) track.add(Time(place * 1s), at_x(place));
  EXPECT_EQ(x(1ns), 1);
  EXPECT_DOUBLE_EQ(x(1500ms), 1.5);
  EXPECT_EQ(x(4s), 2) << "in a gap";
  EXPECT_EQ(x(5s), 5);
  EXPECT_EQ(x(60s), 5);
}

TEST(TrackDeathTest, OutsideIsABug) {
  Track track({});
  track.add(unix_time(10), at_x(0));
  EXPECT_DEATH(static_cast<void>(track.at(unix_time(9))), "9");
  EXPECT_DEATH(static_cast<void>(track.at(unix_time(11))), "11");
  track.add(unix_time(2'000'000'000), at_x(0));
  EXPECT_DEATH(static_cast<void>(track.at(unix_time(11))), "11") << "in a gap";
}

}  // namespace
}  // namespace hc::frames
