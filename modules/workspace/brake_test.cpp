// SPDX-License-Identifier: Apache-2.0
#include "brake.h"

#include <gtest/gtest.h>

namespace {

using std::chrono::milliseconds;

constexpr std::int32_t kPage = 12, kButton = 7;

/// A brake and its clock.
struct Robot {
  Brake brake;
  hc::MonotonicTime now{milliseconds(5000)};
  std::map<std::int32_t, std::int64_t> seq;

  bool takes(std::int32_t source, int word) {
    return brake.take({source, static_cast<std::uint8_t>(word), seq[source]++, now}, now)
        .has_value();
  }
  void say(std::int32_t source, int word) { ASSERT_TRUE(takes(source, word)); }
  /// Repeats a command for this time.
  void repeat(std::int32_t source, int word, milliseconds duration) {
    for (const auto end = now + duration; now < end; now += milliseconds(50)) say(source, word);
  }
  [[nodiscard]] std::string reason() const { return brake.reason(now); }
};

TEST(Brake, a_stop_holds_until_its_own_source_clears_it) {
  Robot robot;
  EXPECT_EQ(robot.reason(), "");
  robot.say(kButton, 1);
  EXPECT_EQ(robot.reason(), "stopped by source 7");
  robot.repeat(kPage, 0, milliseconds(500));
  EXPECT_EQ(robot.reason(), "stopped by source 7");
  robot.say(kPage, 3);
  robot.now += std::chrono::hours(1);
  EXPECT_TRUE(robot.brake.is_stopped());
  robot.say(kButton, 0);
  EXPECT_EQ(robot.reason(), "");
}

TEST(Brake, of_two_stops_each_holds) {
  Robot robot;
  for (auto source : {kButton, kPage}) robot.say(source, 1);
  robot.say(kButton, 0);
  EXPECT_EQ(robot.reason(), "stopped by source 12");
  robot.say(kPage, 0);
  EXPECT_FALSE(robot.brake.is_stopped());
}

TEST(Brake, a_person_clears_all_stops) {
  Robot robot;
  for (auto source : {kButton, kPage, 99}) robot.say(source, 1);
  robot.say(kPage, 2);
  EXPECT_EQ(robot.reason(), "");
}

TEST(Brake, a_stop_that_is_newer_than_what_clears_all_holds) {
  Robot robot;
  robot.say(99, 1);
  const auto said = robot.now += milliseconds(500);
  robot.now += milliseconds(100);
  robot.say(kButton, 1);
  robot.now += milliseconds(100);  // its transit time
  ASSERT_TRUE(robot.brake.take({kPage, Brake::kClearAll, 0, said}, robot.now));
  EXPECT_EQ(robot.reason(), "stopped by source 7");
  EXPECT_FALSE(robot.brake.stops_robot(99));
  robot.say(kPage, 2);
  EXPECT_EQ(robot.reason(), "");
}

TEST(Brake, a_guard_that_is_silent_halts_the_robot_and_its_word_frees_it) {
  Robot robot;
  robot.repeat(kPage, 0, milliseconds(200));
  robot.now += Brake::kSilence - milliseconds(50);
  EXPECT_EQ(robot.reason(), "");
  robot.now += milliseconds(1);
  EXPECT_EQ(robot.reason(), "source 12 is silent: its stop could not arrive");
  EXPECT_FALSE(robot.brake.is_stopped());
  robot.seq.clear();  // its process has been restarted
  robot.say(kPage, 0);
  EXPECT_EQ(robot.reason(), "");
  robot.now += std::chrono::hours(1);
  EXPECT_EQ(robot.reason(), "source 12 is silent: its stop could not arrive");
}

TEST(Brake, a_guard_may_leave_or_be_dismissed_while_it_is_silent) {
  for (int word : {3, 2}) {
    Robot robot;
    robot.repeat(kPage, 0, milliseconds(200));
    if (word == 3) robot.say(kPage, word);
    robot.now += std::chrono::seconds(1);
    EXPECT_EQ(robot.reason().empty(), word == 3);
    if (word == 2) robot.say(kButton, word);
    EXPECT_EQ(robot.reason(), "") << word;
  }
  Robot robot;  // an active one is not dismissed
  robot.repeat(kPage, 0, milliseconds(200));
  robot.say(kButton, 2);
  robot.now += std::chrono::seconds(1);
  EXPECT_EQ(robot.reason(), "source 12 is silent: its stop could not arrive");
}

TEST(Brake, who_says_a_word_now_and_then_guards_nothing) {
  for (int word : {0, 1}) {
    Robot robot;
    robot.say(kButton, word);
    robot.now += Brake::kSilence + milliseconds(1);
    robot.say(kButton, 0);
    robot.now += std::chrono::hours(1);
    EXPECT_EQ(robot.reason(), "") << word;
  }
}

TEST(Brake, who_may_have_forgotten_that_it_stopped_does_not_clear_by_guarding) {
  // Silent for a while; restarted at once with a new count; left by its last page.
  for (int how : {0, 1, 2}) {
    Robot robot;
    robot.repeat(kPage, 1, milliseconds(200));
    if (how == 0) robot.now += Brake::kSilence;
    if (how == 1) robot.seq.clear();
    if (how == 2) robot.say(kPage, 3);
    robot.repeat(kPage, 0, milliseconds(500));
    EXPECT_EQ(robot.reason(), "stopped by source 12") << how;
    if (how == 0) {
      robot.say(kPage, 2);
    } else {
      robot.say(kPage, 1);
      robot.say(kPage, 0);
    }
    EXPECT_EQ(robot.reason(), "") << how;
  }
}

TEST(Brake, stops_and_guards_outlive_the_process) {
  Robot before;
  before.say(kButton, 1);
  before.repeat(kPage, 0, milliseconds(200));
  Robot robot;
  robot.brake.restore(before.brake.stops());
  EXPECT_EQ(robot.brake.stops(), before.brake.stops());
  EXPECT_EQ(robot.reason(), "stopped by source 7");
  robot.repeat(kButton, 0, milliseconds(200));
  EXPECT_EQ(robot.reason(), "stopped by source 7");
  robot.say(kButton, 2);
  robot.say(kPage, 0);
  EXPECT_EQ(robot.reason(), "");
  Robot guarded;
  guarded.brake.restore({{kPage, false}});
  EXPECT_EQ(guarded.reason(), "source 12 is silent: its stop could not arrive");
  guarded.say(kPage, 0);
  EXPECT_EQ(guarded.reason(), "");
}

TEST(Brake, only_a_stop_counts_whenever_it_was_said) {
  Robot robot;
  const auto at = [&](int word, hc::MonotonicTime said) {
    return robot.brake.take({kButton, static_cast<std::uint8_t>(word), 0, said}, robot.now);
  };
  ASSERT_TRUE(at(1, robot.now - std::chrono::hours(500'000)));
  EXPECT_TRUE(robot.brake.is_stopped());
  for (int word : {0, 2, 3})
    for (auto off : {milliseconds(-1000), milliseconds(201), milliseconds(3'600'000)})
      EXPECT_FALSE(at(word, robot.now + off)) << word;
  EXPECT_TRUE(robot.brake.is_stopped());
  EXPECT_FALSE(at(4, robot.now));
  ASSERT_TRUE(at(0, robot.now - milliseconds(999)));
  EXPECT_FALSE(robot.brake.is_stopped());
}

TEST(Brake, sources_are_called_by_their_names) {
  Robot robot;
  robot.brake.set_names({{kPage, "web.stop"}});
  robot.say(kPage, 1);
  EXPECT_EQ(robot.reason(), "stopped by web.stop");
  EXPECT_EQ(robot.brake.name(3), "source 3");
  EXPECT_EQ(robot.brake.name(0), "a program outside the graph");
}

TEST(Brake, any_number_of_sources_is_borne_and_none_is_unheard) {
  Robot robot;
  for (std::int32_t source = 0; source < 1'000'000; ++source)
    robot.say(source, source % 2 == 0 ? 0 : 3);
  EXPECT_TRUE(robot.brake.stops().empty());
  for (std::int32_t source = 0; source < 100; ++source) robot.say(source, 1);
  EXPECT_EQ(robot.brake.stops().size(), Brake::kMostSources + 1);
  EXPECT_FALSE(robot.takes(99, 0));
  for (std::int32_t source = 0; source < 64; ++source) robot.say(source, 0);
  EXPECT_EQ(robot.reason(), "stopped by a source beyond the limit");
  Robot restarted;
  restarted.brake.restore(*hc::parse_stops(hc::stops_text(robot.brake.stops())));
  EXPECT_EQ(restarted.reason(), "stopped by a source beyond the limit");
  for (Robot* each : {&robot, &restarted}) {
    each->say(99, 2);
    EXPECT_EQ(each->reason(), "");
  }
}

}  // namespace
