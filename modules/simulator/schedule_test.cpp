// SPDX-License-Identifier: Apache-2.0
#include "schedule.h"

#include <utility>

#include <gtest/gtest.h>

namespace {

using namespace std::chrono_literals;

constexpr hc::Time kStart(1'700'000'000s);

TEST(Schedule, adds_up_no_errors) {
  EXPECT_EQ(period_end(0, 30), 0s);
  EXPECT_EQ(period_end(1, 30), 33'333'333ns);
  EXPECT_EQ(period_end(3'000'000, 30), 100'000s);
  EXPECT_EQ(period_end(3, 0.5), 6s);
}

TEST(Schedule, has_pair_n_at_n_periods_from_the_start) {
  Schedule schedule(kStart, 20);
  EXPECT_EQ(schedule.time(), kStart);
  schedule.next();
  schedule.next();
  EXPECT_EQ(schedule.number(), 2);
  EXPECT_EQ(schedule.time(), kStart + 100ms);
  EXPECT_DOUBLE_EQ(schedule.seconds(), 0.1);
}

TEST(Schedule, reports_the_first_pair_of_each_second) {
  for (const auto& [rate, expected] : {std::pair{3.0, 4}, {0.1, 10}, {1.4, 10}, {20.0, 1}}) {
    Schedule schedule(kStart, rate);
    int first = 0;
    for (; schedule.number() < 10; schedule.next()) first += schedule.begins_second();
    EXPECT_EQ(first, expected) << rate;
  }
}

TEST(Schedule, leaves_out_what_could_not_be_taken_in_time) {
  Schedule schedule(kStart, 10);
  schedule.catch_up(kStart + 350ms);
  EXPECT_EQ(schedule.number(), 0) << "the first one is always taken";
  schedule.next();
  schedule.catch_up(kStart + 199ms);
  EXPECT_EQ(schedule.number(), 1);
  schedule.catch_up(kStart + 350ms);
  EXPECT_EQ(schedule.number(), 3);
  schedule.next();
  schedule.catch_up(kStart + 360ms);  // never back
  EXPECT_EQ(schedule.number(), 4);
}

TEST(Schedule, goes_on_as_it_was_when_the_clock_is_set) {
  Schedule schedule(kStart, 10);
  for (const std::chrono::seconds by : {3600s, 0s, -3600s, -1'700'000'000s}) {
    schedule.next();
    const auto number = schedule.number();
    const double seconds = schedule.seconds();
    schedule.catch_up(kStart + by);
    EXPECT_EQ(schedule.number(), number);
    EXPECT_EQ(schedule.time(), kStart + by);
    EXPECT_NEAR(schedule.seconds(), seconds, 1e-6);
  }
}

TEST(Schedule, waits_for_its_time_and_for_the_gaze) {
  Schedule schedule(kStart, 10);
  EXPECT_FALSE(schedule.is_due(kStart - 1ns, false));
  EXPECT_TRUE(schedule.is_due(kStart, false));
  EXPECT_FALSE(schedule.is_due(kStart, true));
}

TEST(Schedule, a_second_begins_though_its_first_pair_is_dropped) {
  Schedule schedule(kStart, 10);
  schedule.next();
  EXPECT_FALSE(schedule.begins_second());
  schedule.catch_up(kStart + 1250ms);
  EXPECT_EQ(schedule.number(), 12);
  EXPECT_TRUE(schedule.begins_second());
  schedule.next();
  EXPECT_FALSE(schedule.begins_second());
}

}  // namespace
