// SPDX-License-Identifier: Apache-2.0
// Units that are silent, late, switched off, or not to be understood.
#include <drivers/pan_tilt/conversation.h>

#include <gtest/gtest.h>

#include "line_test.h"

namespace hc::pan_tilt {
namespace {

TEST_F(Conversing, a_silent_unit_is_asked_anew_and_then_given_up) {
  line.is_silent = true;
  line.run(Conversation::kTimeOut + milliseconds(30));
  EXPECT_EQ(line.faults, std::vector<std::string>{"the unit does not answer"});
  EXPECT_EQ(line.host.phase(), Phase::Begins);
  EXPECT_FALSE(line.host.command(line.now, 0, 0));
  line.run((Conversation::kTries + 1) * Conversation::kTimeOut);
  EXPECT_EQ(line.host.phase(), Phase::Lost);
}

TEST_F(Conversing, no_old_command_is_sent_when_the_unit_is_back_but_its_motion_is_halted) {
  line.host.set_hold(milliseconds(200));
  line.host.command(line.now, 2, 0);
  line.step();
  line.host.command(line.now, 1, 0);  // waits for the first one's answer, which is lost
  line.is_silent = true;
  line.coming.clear();
  line.run(Conversation::kTimeOut + milliseconds(100));
  line.is_silent = false;
  line.asked.clear();
  line.run(milliseconds(1000));
  EXPECT_EQ(line.host.phase(), Phase::Ready);
  EXPECT_EQ(line.asked.find("pp1"), std::string::npos) << line.asked;
  EXPECT_EQ(line.asked.find("pp2"), std::string::npos) << line.asked;
  EXPECT_NE(line.asked.find("h "), std::string::npos) << line.asked;
}

TEST(Conversation, late_answers_are_borne) {
  Line line;
  line.delay = milliseconds(300);
  line.host.begin(line.now);
  line.run(milliseconds(9000));
  EXPECT_EQ(line.host.phase(), Phase::Ready);
  EXPECT_TRUE(line.faults.empty());
  EXPECT_GT(line.gazes.size(), 2U);
}

/// Puts the line right again, and checks that what the host believes is true.
void check_recovery(Line& line) {
  line.delay = milliseconds(2);
  line.garbage = 0;
  for (int i = 0; i < 10'000 && line.host.phase() != Phase::Ready; ++i) {
    if (line.host.phase() == Phase::Lost) line.host.begin(line.now);
    line.step();
  }
  line.run(milliseconds(2000));
  ASSERT_EQ(line.host.phase(), Phase::Ready);
  EXPECT_EQ(line.host.character(),
            "pan from -158.9 to 158.9, tilt from -31.1 (up) to 46.6 (down) degrees");
  const double time = std::chrono::duration<double>(line.now).count();
  EXPECT_NEAR(line.gazes.back().pan, line.unit.pan(time) * kStep, kStep);
  EXPECT_NEAR(line.gazes.back().tilt, -line.unit.tilt(time) * kStep, kStep);
}

TEST(Conversation, answers_that_are_too_late_are_not_taken_for_others) {
  Line line;
  line.unit = Unit(700, -300);
  line.delay = milliseconds(700);
  line.host.begin(line.now);
  for (int i = 0; i < 20'000; ++i) {
    if (line.host.phase() == Phase::Lost) line.host.begin(line.now);
    line.step();
  }
  for (const Gaze& gaze : line.gazes) {
    EXPECT_NEAR(gaze.pan, 700 * kStep, kStep);
    EXPECT_NEAR(gaze.tilt, 300 * kStep, kStep);
  }
  check_recovery(line);
}

TEST(Conversation, an_answer_to_an_older_question_is_found_out) {
  Line line;
  line.host.begin(line.now);
  for (char byte : std::string("* 22\r\n")) line.coming.emplace_back(line.now, byte);
  line.run(milliseconds(1000));
  ASSERT_FALSE(line.faults.empty());
  EXPECT_TRUE(line.faults[0].starts_with("garbage: ")) << line.faults[0];
  check_recovery(line);
}

TEST(Conversation, a_spoilt_answer_is_not_believed_for_ever) {
  Line line;
  line.unit.take(1, "ft ed ci ");
  line.host.begin(line.now);
  line.host.bytes();
  line.host.take(line.now, "*\r\n*\r\n*\r\n* 125.1428\r\n");
  line.run(milliseconds(1000));
  EXPECT_EQ(line.faults,
            std::vector<std::string>{"garbage: \"185.1428\" answers nothing that was asked"});
  check_recovery(line);
}

TEST(Conversation, garbage_is_told_and_got_over) {
  Line line;
  line.unit = Unit(700, -300);
  line.begin();
  line.garbage = 0.01;
  std::size_t most = 0;
  for (int i = 0; i < 30'000; ++i) {
    if (line.host.phase() == Phase::Lost) line.host.begin(line.now);
    line.step();
    if (line.host.phase() == Phase::Ready) ++most;
  }
  EXPECT_GT(most, 3000U);  // of 30,000 ms
  ASSERT_FALSE(line.faults.empty());
  EXPECT_TRUE(line.faults[0].starts_with("garbage: ")) << line.faults[0];
  check_recovery(line);
}

TEST(Conversation, nothing_but_garbage_is_given_up) {
  Line line;
  line.garbage = 1;
  line.host.begin(line.now);
  line.run(milliseconds(2100));
  EXPECT_EQ(line.host.phase(), Phase::Lost);
}

TEST_F(Conversing, a_unit_that_was_switched_off_and_on_is_made_terse_again) {
  line.host.set_pace(0.5, 0);
  line.run(milliseconds(100));
  line.unit = Unit(10, 20);
  line.run(milliseconds(1500));
  EXPECT_EQ(line.host.phase(), Phase::Ready);
  EXPECT_NEAR(line.gazes.back().pan, 10 * kStep, 1e-9);
  EXPECT_TRUE(line.unit.take(10, "ps ").find("* 557") != std::string::npos);
}

TEST_F(Conversing, a_place_where_it_cannot_be_is_garbage) {
  line.looks = false;
  line.run(milliseconds(50));
  line.gazes.clear();
  line.host.look(line.now);
  line.host.bytes();
  line.host.take(line.now, "* 2200\r\n* 0\r\n");
  EXPECT_EQ(line.host.fault()->detail, "garbage: it cannot be at 2200");
  EXPECT_FALSE(line.host.gaze());
}

}  // namespace
}  // namespace hc::pan_tilt
