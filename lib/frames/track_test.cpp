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
  EXPECT_EQ(track.add(1000, at_x(0)), Fed::Added);
  EXPECT_EQ(track.known(), (TimeSpan{1000, 1000}));
  EXPECT_EQ(track.at(1000).p.x(), 0);
  EXPECT_EQ(track.add(2000, at_x(8)), Fed::Added);
  EXPECT_EQ(track.add(1500, at_x(1)), Fed::Added) << "late, but within what is remembered";
  EXPECT_EQ(track.known(), (TimeSpan{1000, 2000}));
  EXPECT_EQ(track.at(1250).p.x(), 0.5);
  EXPECT_EQ(track.at(1500).p.x(), 1);
  EXPECT_EQ(track.at(1750).p.x(), 4.5);
}

TEST(Track, ARepeatedTimeReplaces) {
  Track track({});
  track.add(1000, at_x(0));
  track.add(2000, at_x(8));
  EXPECT_EQ(track.add(2000, at_x(4)), Fed::Replaced);
  EXPECT_EQ(track.at(1500).p.x(), 2);
  EXPECT_EQ(track.add(1000, at_x(2)), Fed::Replaced);
  EXPECT_EQ(track.at(1500).p.x(), 3);
  track.clear();
  EXPECT_TRUE(track.empty());
  EXPECT_EQ(track.add(1, at_x(0)), Fed::Added) << "a clock that starts over";
}

TEST(Track, RemembersASpan) {
  Track track({.span = std::chrono::nanoseconds(100)});
  for (std::int64_t time : {1, 50, 101}) EXPECT_EQ(track.add(time, at_x(0)), Fed::Added);
  EXPECT_EQ(track.known(), (TimeSpan{1, 101}));
  EXPECT_EQ(track.add(102, at_x(0)), Fed::Added);
  EXPECT_EQ(track.known(), (TimeSpan{50, 102}));
  EXPECT_EQ(track.add(1, at_x(0)), Fed::TooOld);
  EXPECT_EQ(track.add(2, at_x(0)), Fed::Added);
  EXPECT_EQ(track.known(), (TimeSpan{2, 102}));
  EXPECT_EQ(track.add(10'000, at_x(0)), Fed::Added);
  EXPECT_EQ(track.known(), (TimeSpan{10'000, 10'000}));
}

TEST(Track, RemembersACount) {
  Track track({.poses = 2});
  for (std::int64_t time : {10, 20, 30}) EXPECT_EQ(track.add(time, at_x(0)), Fed::Added);
  EXPECT_EQ(track.known(), (TimeSpan{20, 30}));
  EXPECT_EQ(track.add(15, at_x(0)), Fed::TooOld);
  EXPECT_EQ(track.add(20, at_x(0)), Fed::Replaced);
  EXPECT_EQ(track.add(25, at_x(0)), Fed::Added);
  EXPECT_EQ(track.known(), (TimeSpan{25, 30}));
}

TEST(Track, BearsTheFirstAndLastTimesThereAre) {
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  Track track({.span = std::chrono::nanoseconds::max(), .gap = std::chrono::nanoseconds::max()});
  track.add(kLast, at_x(1));
  track.add(1, at_x(0));
  EXPECT_EQ(track.known(), (TimeSpan{1, kLast}));
  EXPECT_NEAR(track.at(kLast / 2).p.x(), 0.5, 1e-15);
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
      Fed fed = track.add(time, pose);
      bool is_new = !all.contains(time);
      all[time] = pose;
      while (all.size() > static_cast<std::size_t>(count) ||
             all.rbegin()->first - all.begin()->first > span)
        all.erase(all.begin());
      ASSERT_EQ(fed, !all.contains(time) ? Fed::TooOld : is_new ? Fed::Added : Fed::Replaced);
      ASSERT_EQ(track.known(), (TimeSpan{all.begin()->first, all.rbegin()->first}));
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
      auto until = track.known_until(last);
      while (last >= all.begin()->first && !is_known(last)) --last;
      if (last >= all.begin()->first) {
        expected_span = {last, last};
        while (is_known(expected_span->first - 1)) --expected_span->first;
      }
      ASSERT_EQ(until, expected_span);
      auto hole = track.gap_at(asked);
      ASSERT_EQ(hole.has_value(), !is_known(asked));
      if (hole) {
        ASSERT_EQ(*hole, (TimeSpan{before->first, next->first}));
        continue;
      }
      Eigen::Matrix4d expected = next->second.transformation().matrix();
      if (next->first != asked)
        expected = interpolated(before->second.transformation().matrix(), expected,
                                static_cast<double>(asked - before->first) /
                                    static_cast<double>(next->first - before->first));
      ASSERT_LT((track.at(asked).transformation().matrix() - expected).norm(), 1e-9);
    }
  }
}

TEST(Track, BridgesNoGap) {
  Track track({.gap = std::chrono::nanoseconds(100)});
  for (std::int64_t time : {100, 200, 301, 350}) track.add(time, at_x(static_cast<double>(time)));
  EXPECT_EQ(track.at(150).p.x(), 150) << "as far apart as is bridged";
  EXPECT_EQ(track.gap_at(150), std::nullopt);
  EXPECT_EQ(track.gap_at(201), (TimeSpan{200, 301}));
  for (std::int64_t time : {200, 301}) EXPECT_EQ(track.at(time).p.x(), time);
  EXPECT_EQ(track.known(), (TimeSpan{100, 350}));
  EXPECT_EQ(track.known_until(1000), (TimeSpan{301, 350}));
  EXPECT_EQ(track.known_until(310), (TimeSpan{301, 310}));
  EXPECT_EQ(track.known_until(300), (TimeSpan{100, 200}));
  EXPECT_EQ(track.known_until(99), std::nullopt);
  track.add(260, at_x(0));
  EXPECT_EQ(track.gap_at(201), std::nullopt) << "a late pose closes it";
}

TEST(Track, TheNearestPoseIsThatOfWhatStandsStill) {
  Track track{Memory{}};
  constexpr std::int64_t kSecond = 1'000'000'000;
  auto x = [&](std::int64_t time) { return track.nearest(time).p.x(); };
  for (auto [time, place] : {std::pair{kSecond, 1.0}, {2 * kSecond, 2.0}, {5 * kSecond, 5.0}})
    track.add(time, at_x(place));
  EXPECT_EQ(x(1), 1);
  EXPECT_DOUBLE_EQ(x(kSecond + kSecond / 2), 1.5);
  EXPECT_EQ(x(4 * kSecond), 2) << "in a gap";
  EXPECT_EQ(x(5 * kSecond), 5);
  EXPECT_EQ(x(60 * kSecond), 5);
}

TEST(TrackDeathTest, OutsideIsABug) {
  Track track({});
  track.add(10, at_x(0));
  EXPECT_DEATH(static_cast<void>(track.at(9)), "9");
  EXPECT_DEATH(static_cast<void>(track.at(11)), "11");
  track.add(2'000'000'000, at_x(0));
  EXPECT_DEATH(static_cast<void>(track.at(11)), "11") << "in a gap";
}

}  // namespace
}  // namespace hc::frames
