// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <drivers/pan_tilt/line_test.h>

namespace hc::pan_tilt {
namespace {

struct Begun : testing::Test {
  void SetUp() override {
    line.begin();
    line.commands();
  }
  Line line;
};

TEST(Conversation, begins_as_drivers_do_and_asks_what_is_there) {
  Line line;
  line.looks = false;
  line.begin();
  EXPECT_EQ(
      line.asked,
      "- ft ed ci pr tr pn px tn tx pu tu pl tl ps ts pa ta pr tr pn px tn tx pu tu pl tl ps ts "
      "pa ta ");
  EXPECT_TRUE(line.faults.empty()) << line.faults[0];
  EXPECT_EQ(line.host.character(),
            "pan from -158.9 to 158.9, tilt from -31.1 (up) to 46.6 (down) degrees");
}

TEST(Conversation, reports_where_the_unit_looks_and_when) {
  Line line;
  line.delay = milliseconds(8);
  line.begin();
  line.unit.take(1.3, "pp1000 tp-100 ");
  line.gazes.clear();
  line.run(milliseconds(200));
  ASSERT_GE(line.gazes.size(), 3U);
  for (const Gaze& gaze : line.gazes) {
    // Asked at a multiple of 20 ms, answered 8 ms later and read with the next poll.
    EXPECT_NEAR(static_cast<double>(gaze.time.count() % 20'000'000), 4e6, 1.1e6);
  }
  const Gaze last = line.gazes.back();
  const double seconds = std::chrono::duration<double>(last.time).count();
  EXPECT_NEAR(last.pan, (seconds - 1.3) * 1000 * kStep, 10 * kStep);
  EXPECT_NEAR(last.tilt, 100 * kStep, 10 * kStep);
}

TEST(Conversation, on_a_slow_line_a_gaze_has_the_time_at_which_the_unit_looked_there) {
  Line line;
  line.begin_slowly();
  line.gazes.clear();
  std::deque<std::pair<MonotonicTime, double>> turned;  // times and angles
  line.host.command(line.now, 1, 0.5);
  for (int i = 0; i < 800; ++i) {
    turned.emplace_back(line.now, line.unit.pan(line.seconds()));
    if (i % 30 == 0) line.host.command(line.now, 1 + 0.001 * i, 0.5);  // before the question
    line.step();
  }
  // A poll begins while the previous answers are still on the line.
  ASSERT_GT(line.gazes.size(), 35U);
  for (const auto& gaze : line.gazes) {
    const auto at = std::find_if(turned.begin(), turned.end(),
                                 [&](const auto& each) { return each.first >= gaze.time; });
    ASSERT_NE(at, turned.end());
    // Answers to commands are ahead of it on the line. A step is 1 ms.
    constexpr double kFastest = 1.05, kOff = 0.0015;  // [rad/s], [s]
    EXPECT_NEAR(gaze.pan, at->second * kStep, kFastest * kOff);
  }
}

TEST(Conversation, an_answer_that_is_read_late_has_the_time_at_which_the_unit_looked_there) {
  Line line;
  line.begin_slowly();
  line.run(milliseconds(500));
  line.gazes.clear();
  line.host.command(line.now, 1, 0.5);
  line.run(milliseconds(700));  // until its speed is constant
  const double speed =
      (line.unit.pan(line.seconds()) - line.unit.pan(line.seconds() - 0.001)) * 1e3;
  for (int i = 0; i < 10; ++i) {
    const double at = line.unit.pan(line.seconds()), from = line.seconds();
    line.gazes.clear();
    line.run(milliseconds(20));
    line.is_read = false;  // another process has the processor
    line.run(milliseconds(9));
    line.is_read = true;
    line.run(milliseconds(11));
    for (const auto& gaze : line.gazes) {
      const double passed = std::chrono::duration<double>(gaze.time).count() - from;
      EXPECT_NEAR(gaze.pan / kStep, at + speed * passed, 0.002 * speed) << "2 ms";
    }
  }
}

TEST(Conversation, on_a_slow_line_the_tilt_is_that_of_the_time_of_the_pan) {
  Line line;
  line.begin_slowly();
  line.host.command(line.now, 0, 0.8);
  line.run(milliseconds(150));  // until its speed is constant
  line.gazes.clear();
  const auto begin = line.now;
  const auto tilt = [&] { return -line.unit.tilt(line.seconds()) * kStep; };
  const double first = tilt();
  line.run(milliseconds(400));
  const double speed = (tilt() - first) / 0.4;
  ASSERT_GT(line.gazes.size(), 8U);
  double late = 0;  // [s]
  for (std::size_t i = 1; i < line.gazes.size(); ++i) {
    const double passed = std::chrono::duration<double>(line.gazes[i].time - begin).count();
    late += ((line.gazes[i].tilt - first) / speed - passed) /
            static_cast<double>(line.gazes.size() - 1);
  }
  EXPECT_NEAR(late, 0, 0.0015) << "its question takes 3 ms";
}

TEST_F(Begun, a_command_goes_at_once_beside_a_question) {
  line.host.look(line.now);
  EXPECT_EQ(line.host.bytes(line.now), "pp tp ");
  EXPECT_TRUE(line.host.command(line.now, 100 * kStep, 50 * kStep));
  EXPECT_EQ(line.host.bytes(line.now), "pp100 tp-50 ");
}

TEST_F(Begun, of_commands_that_must_wait_the_newest_is_sent) {
  for (int i = 1; i <= 50; ++i) line.host.command(line.now, i * kStep, 0);
  line.run(milliseconds(50));
  EXPECT_EQ(line.commands(), "pp1 tp0 pp50 tp0 ");
}

TEST_F(Begun, never_has_more_than_a_question_and_a_command_without_answer) {
  line.is_silent = true;
  line.asked.clear();
  for (int i = 0; i < 400; ++i) {
    line.host.command(line.now, 0.001 * i, 0);
    line.step();
  }
  EXPECT_LE(std::count(line.asked.begin(), line.asked.end(), ' '), 4);
}

TEST_F(Begun, commands_are_brought_within_the_limits) {
  line.host.command(line.now, 99, -1e300);
  line.run(milliseconds(50));
  line.host.command(line.now, -99, 99);
  line.run(milliseconds(50));
  EXPECT_EQ(line.commands(), "pp3090 tp604 pp-3090 tp-907 ");
  EXPECT_TRUE(line.remarks.empty());
}

TEST_F(Begun, a_command_that_is_the_same_is_not_sent_again) {
  for (int i = 0; i < 5; ++i) {
    line.host.command(line.now, 0.1, 0);
    line.run(milliseconds(20));
  }
  EXPECT_EQ(line.commands(), "pp111 tp0 ");
}

TEST_F(Begun, a_silent_unit_is_asked_again_and_then_given_up) {
  line.is_silent = true;
  line.run(Conversation::kTimeOut + milliseconds(30));
  EXPECT_EQ(line.faults, std::vector<std::string>{"no answer from the unit for 0.5 s"});
  EXPECT_EQ(line.host.phase(), Phase::Begins);
  EXPECT_FALSE(line.host.command(line.now, 0, 0));
  line.run((Conversation::kTries + 1) * Conversation::kTimeOut);
  EXPECT_EQ(line.host.phase(), Phase::Lost);
}

TEST_F(Begun, a_question_counts_from_when_it_is_written) {
  line.looks = false;
  line.run(milliseconds(50));
  line.gazes.clear();
  line.host.look(line.now);
  line.now += milliseconds(30);  // the process waits before it writes
  line.run(milliseconds(50));
  ASSERT_EQ(line.gazes.size(), 1U);
  const auto late = line.now - milliseconds(50) - line.gazes[0].time;
  EXPECT_LT(std::chrono::abs(late), milliseconds(3));
}

TEST_F(Begun, an_answer_to_a_question_that_is_not_written_is_harmless) {
  line.looks = false;
  line.run(milliseconds(50));
  line.host.look(line.now);
  line.host.take(line.now, "* 0\r\n* 0\r\n");
  line.run(milliseconds(1000));
  EXPECT_EQ(line.host.phase(), Phase::Ready);
}

TEST_F(Begun, an_answer_that_was_not_read_in_time_gives_no_gaze) {
  line.looks = false;
  line.run(milliseconds(50));
  line.gazes.clear();
  line.host.look(line.now);
  line.host.bytes(line.now);
  line.host.take(line.now + milliseconds(1000), "* 0\r\n* 0\r\n");
  EXPECT_FALSE(line.host.gaze());
  EXPECT_EQ(line.host.phase(), Phase::Ready);
}

TEST(Conversation, commands_on_a_slow_line_leave_no_gap_between_looks) {
  Line line;
  line.begin_slowly();
  line.gazes.clear();
  for (int i = 0; i < 2000; ++i) {
    ASSERT_TRUE(line.host.command(line.now, -1e-3 * i, 0.3 + 1e-4 * i));
    line.step();
  }
  ASSERT_GT(line.gazes.size(), 2U);
  for (std::size_t i = 1; i < line.gazes.size(); ++i)
    EXPECT_LT(line.gazes[i].time - line.gazes[i - 1].time, milliseconds(35));
}

TEST(Conversation, late_answers_are_borne) {
  Line line;
  line.delay = milliseconds(300);
  line.host.begin(line.now);
  line.run(milliseconds(10'200));
  EXPECT_EQ(line.host.phase(), Phase::Ready);
  EXPECT_TRUE(line.faults.empty());
  EXPECT_GT(line.gazes.size(), 2U);
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

TEST(Conversation, a_corrupted_answer_is_not_believed_for_ever) {
  Line line;
  line.unit.take(1, "ft ed ci ");
  line.host.begin(line.now);
  line.host.bytes(line.now);
  line.host.take(line.now, "*\r\n*\r\n*\r\n* 125.1428\r\n");
  line.run(milliseconds(1000));
  EXPECT_EQ(line.faults, std::vector<std::string>{"garbage: \"185.1428\" is an unexpected answer"});
  check_recovery(line);
}

TEST(Conversation, garbage_is_reported_and_skipped) {
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

TEST_F(Begun, a_unit_that_was_switched_off_and_on_is_made_terse_again) {
  line.host.set_pace(0.5, 0);
  line.run(milliseconds(100));
  line.unit = Unit(10, 20);
  line.run(milliseconds(1500));
  EXPECT_EQ(line.host.phase(), Phase::Ready);
  EXPECT_NEAR(line.gazes.back().pan, 10 * kStep, 1e-9);
  EXPECT_TRUE(line.unit.take(10, "ps ").find("* 557") != std::string::npos);
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

TEST(Conversation, asked_slower_than_it_can_the_unit_turns_as_slowly_as_it_can) {
  Line line;
  line.host.set_pace(0.02, 0);
  line.begin();
  line.run(milliseconds(50));
  EXPECT_NE(line.commands().find("ps31 ts31 "), std::string::npos);
  EXPECT_EQ(line.remarks, std::vector<std::string>{"turns no slower than 0.027826 rad/s"});
  line.host.command(line.now, 0.5, 0);
  line.run(milliseconds(1000));
  EXPECT_NEAR(line.gazes.back().pan, 31 * kStep, 3 * kStep);
}

TEST_F(Begun, no_command_is_taken_until_a_pace_is_accepted) {
  line.unit.take(1.3, "pl200 tl200 ");  // by another program, unknown to the host
  line.commands();
  line.host.set_pace(0.05, 0);
  line.host.pass(line.now);
  EXPECT_TRUE(line.host.command(line.now, 1, 0));  // waits until the pace is accepted
  line.run(milliseconds(100));
  EXPECT_EQ(line.commands(), "ps56 ts56 pa2000 ta2000 ");
  ASSERT_FALSE(line.remarks.empty());
  EXPECT_EQ(line.remarks[0], "refused: Tilt speed cannot be below 200 positions/sec");
  EXPECT_FALSE(line.host.command(line.now, 1, 0));
  line.run(Conversation::kTimeOut);
  EXPECT_EQ(line.commands(), "ps56 ts56 pa2000 ta2000 ");
  line.unit.take(2, "pl31 tl31 ");
  line.run(Conversation::kTimeOut);
  line.commands();
  EXPECT_TRUE(line.host.command(line.now, 1, 0));
  line.run(milliseconds(1000));
  EXPECT_EQ(line.commands(), "pp1114 tp0 ");
  EXPECT_NEAR(line.gazes.back().pan, 56 * kStep, 3 * kStep);
  // A different pace is tried at once.
  line.unit.take(10, "pl200 ");
  line.host.set_pace(0.06, 0);
  line.run(milliseconds(50));
  EXPECT_FALSE(line.host.command(line.now, 1, 0));
  line.host.set_pace(0.5, 0);
  line.run(milliseconds(50));
  EXPECT_TRUE(line.host.command(line.now, 1, 0));
}

TEST(Conversation, speeds_with_a_sign_or_none_are_no_pace_of_a_unit) {
  Line line;
  line.unit.take(1, "ft ed cv ps-500 ts0 ");
  line.begin();
  line.run(milliseconds(50));
  EXPECT_NE(line.commands().find("ps500 ts31 pa2000 ta2000 "), std::string::npos);
  EXPECT_TRUE(line.faults.empty()) << line.faults[0];
}

TEST(Conversation, half_a_word_that_was_left_in_the_unit_is_not_carried_out) {
  for (const char* left : {"pp30", "p", "h", "cv", "ps-"}) {
    Line line;
    line.unit.take(1, left);
    line.begin();
    EXPECT_TRUE(line.faults.empty()) << line.faults[0];
    EXPECT_TRUE(line.host.command(line.now, 0, 0));
    line.run(milliseconds(50));
    EXPECT_EQ(line.unit.pan(line.seconds()), 0) << left;
    EXPECT_EQ(line.unit.take(2, "f e c "), "* terse mode\r\n* OFF\r\n* Independent Mode\r\n");
  }
}

TEST_F(Begun, what_the_unit_refuses_or_runs_into_is_a_remark) {
  line.looks = false;
  line.run(milliseconds(50));
  line.host.take(line.now, "!T!P");
  EXPECT_EQ(line.host.remark(), "pan has run into its limit");
  line.host.command(line.now, 0.1, 0);
  line.host.bytes(line.now);
  line.host.take(line.now, "! Illegal command entered\r\n*\r\n");
  EXPECT_EQ(line.host.remark(), "refused: Illegal command entered");
  EXPECT_EQ(line.host.phase(), Phase::Ready);
}

TEST_F(Begun, a_place_where_it_cannot_be_is_garbage) {
  line.looks = false;
  line.run(milliseconds(50));
  line.gazes.clear();
  line.host.look(line.now);
  line.host.bytes(line.now);
  line.host.take(line.now, "* 2200\r\n* 0\r\n");
  EXPECT_EQ(line.host.fault()->detail, "garbage: impossible position 2200");
  EXPECT_FALSE(line.host.gaze());
}

}  // namespace
}  // namespace hc::pan_tilt
