// SPDX-License-Identifier: Apache-2.0
#include <drivers/pan_tilt/conversation.h>

#include <gtest/gtest.h>

#include <algorithm>

#include "line_test.h"

namespace hc::pan_tilt {
namespace {

TEST(Conversation, begins_as_drivers_do_and_asks_what_is_there) {
  Line line;
  line.looks = false;
  line.begin();
  EXPECT_EQ(line.asked,
            "ft ed ci pr tr pn px tn tx pu tu ps ts pa ta pr tr pn px tn tx pu tu ps ts pa ta ");
  EXPECT_TRUE(line.faults.empty()) << line.faults[0];
  EXPECT_EQ(line.host.character(),
            "pan from -158.9 to 158.9, tilt from -31.1 (up) to 46.6 (down) degrees");
}

TEST(Conversation, tells_where_the_unit_looks_and_when) {
  Line line;
  line.delay = milliseconds(8);
  line.begin();
  line.unit.take(1.3, "pp1000 tp-100 ");
  line.gazes.clear();
  line.run(milliseconds(200));
  ASSERT_GE(line.gazes.size(), 3U);
  for (const Gaze& gaze : line.gazes) {
    // Asked at a multiple of 20 ms, answered 8 ms later and taken with the next look.
    EXPECT_NEAR(static_cast<double>(gaze.time.count() % 20'000'000), 4e6, 1.1e6);
  }
  const Gaze last = line.gazes.back();
  const double told = std::chrono::duration<double>(last.time).count();
  EXPECT_NEAR(last.pan, (told - 1.3) * 1000 * kStep, 10 * kStep);
  EXPECT_NEAR(last.tilt, 100 * kStep, 10 * kStep);
}

TEST_F(Conversing, a_command_goes_at_once_beside_a_question) {
  line.host.look(line.now);
  EXPECT_EQ(line.host.bytes(), "pp tp ");
  EXPECT_TRUE(line.host.command(line.now, 100 * kStep, 50 * kStep));
  EXPECT_EQ(line.host.bytes(), "pp100 tp-50 ");
}

TEST_F(Conversing, of_commands_that_must_wait_the_newest_is_sent) {
  for (int i = 1; i <= 50; ++i) line.host.command(line.now, i * kStep, 0);
  line.run(milliseconds(50));
  EXPECT_EQ(line.commands(), "pp1 tp0 pp50 tp0 ");
}

TEST_F(Conversing, never_has_more_than_a_question_and_a_command_without_answer) {
  line.is_silent = true;
  line.asked.clear();
  for (int i = 0; i < 400; ++i) {
    line.host.command(line.now, 0.001 * i, 0);
    line.step();
  }
  EXPECT_LE(std::count(line.asked.begin(), line.asked.end(), ' '), 4);
}

TEST_F(Conversing, commands_are_brought_within_the_limits) {
  line.host.command(line.now, 99, -1e300);
  line.run(milliseconds(50));
  line.host.command(line.now, -99, 99);
  line.run(milliseconds(50));
  EXPECT_EQ(line.commands(), "pp3090 tp604 pp-3090 tp-907 ");
  EXPECT_TRUE(line.remarks.empty());
}

TEST_F(Conversing, a_command_that_is_the_same_is_not_sent_again) {
  for (int i = 0; i < 5; ++i) {
    line.host.command(line.now, 0.1, 0);
    line.run(milliseconds(20));
  }
  EXPECT_EQ(line.commands(), "pp111 tp0 ");
}

TEST_F(Conversing, a_motion_is_halted_when_commands_end) {
  line.host.set_hold(milliseconds(200));
  line.host.command(line.now, 2, 0);
  line.run(milliseconds(199));
  EXPECT_EQ(line.commands(), "pp2228 tp0 ");
  line.run(milliseconds(5));
  EXPECT_EQ(line.commands(), "h ");
  line.run(milliseconds(1000));
  EXPECT_EQ(line.commands(), "");
  EXPECT_NEAR(line.gazes.back().pan, 0.2 * 1000 * kStep, 10 * kStep);
  line.host.command(line.now, 2, 0);  // the same place: the unit has to be told again
  line.run(milliseconds(20));
  EXPECT_EQ(line.commands(), "pp2228 tp0 ");
}

TEST_F(Conversing, a_place_that_was_reached_needs_no_halt) {
  line.host.set_hold(milliseconds(200));
  line.host.command(line.now, 0.05, 0);
  line.run(milliseconds(2000));
  EXPECT_EQ(line.commands(), "pp56 tp0 ");
}

TEST(Conversation, a_pace_is_set_and_given_back) {
  Line line;
  line.host.set_pace(1, 4);
  line.begin();
  EXPECT_NE(line.commands().find("ps1114 ts1114 pa4456 ta4456 "), std::string::npos);
  line.host.set_pace(1e6, 0);
  line.run(milliseconds(50));
  EXPECT_EQ(line.commands(), "ps2902 ts2902 pa2000 ta2000 ");
  line.host.set_pace(0, 0);
  line.run(milliseconds(50));
  EXPECT_EQ(line.commands(), "ps1000 ts1000 pa2000 ta2000 ");
}

TEST_F(Conversing, what_the_unit_refuses_or_runs_into_is_a_remark) {
  line.looks = false;
  line.run(milliseconds(50));
  line.host.take(line.now, "!T!P");
  EXPECT_EQ(line.host.remark(), "pan has run into its limit");
  line.host.command(line.now, 0.1, 0);
  line.host.bytes();
  line.host.take(line.now, "! Illegal command entered\r\n*\r\n");
  EXPECT_EQ(line.host.remark(), "refused: Illegal command entered");
  EXPECT_EQ(line.host.phase(), Phase::Ready);
}

}  // namespace
}  // namespace hc::pan_tilt
