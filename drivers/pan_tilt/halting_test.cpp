// SPDX-License-Identifier: Apache-2.0
// Late commands are not sent, and moving axes are halted.
#include <drivers/pan_tilt/line_test.h>

namespace hc::pan_tilt {
namespace {

struct Holding : testing::Test {
  void SetUp() override {
    line.host.set_hold(milliseconds(200));
    line.begin();
    line.commands();
  }
  Line line;
};

TEST_F(Holding, a_motion_is_halted_when_commands_end) {
  line.host.command(line.now, 2, 0);
  line.run(milliseconds(199));
  EXPECT_EQ(line.commands(), "pp2228 tp0 ");
  line.run(milliseconds(5));
  EXPECT_EQ(line.commands(), "h ");
  line.run(milliseconds(1000));
  EXPECT_EQ(line.commands(), "");
  EXPECT_NEAR(line.gazes.back().pan, 0.2 * 1000 * kStep, 10 * kStep);
  line.host.command(line.now, 2, 0);  // same position: the command must be sent again
  line.run(milliseconds(20));
  EXPECT_EQ(line.commands(), "pp2228 tp0 ");
}

TEST_F(Holding, a_place_that_was_reached_needs_no_halt) {
  line.host.command(line.now, 0.05, 0);
  line.run(milliseconds(2000));
  EXPECT_EQ(line.commands(), "pp56 tp0 ");
}

TEST_F(Holding, no_old_command_is_sent_when_the_unit_is_back_but_its_motion_is_halted) {
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

TEST(Halting, a_command_that_has_waited_too_long_is_not_sent) {
  Line line;
  line.begin();
  line.delay = milliseconds(300);
  line.commands();
  line.host.command(line.now, 10 * kStep, 0);
  line.run(milliseconds(50));
  line.host.command(line.now, 20 * kStep, 0);  // too old when the answer to the first one comes
  line.run(milliseconds(300));
  EXPECT_EQ(line.commands(), "pp10 tp0 ");
  line.host.command(line.now, 30 * kStep, 0);
  line.run(milliseconds(50));
  line.host.command(line.now, 40 * kStep, 0, milliseconds(400));
  line.run(milliseconds(300));
  EXPECT_EQ(line.commands(), "pp30 tp0 pp40 tp0 ");
  line.run(milliseconds(400));
  line.host.command(line.now, 50 * kStep, 0);
  line.host.command(line.now, 60 * kStep, 0);
  line.now += milliseconds(1000);  // not polled for this time: the process was stopped
  line.host.take(line.now, "*\r\n*\r\n*\r\n*\r\n");
  EXPECT_EQ(line.host.bytes(line.now).find("pp60"), std::string::npos);
}

TEST(Halting, a_motion_is_halted_though_nothing_can_be_heard) {
  for (bool is_silent : {false, true}) {
    Line line;
    line.host.set_hold(milliseconds(200));
    line.begin();
    line.host.command(line.now, 2.5, 0);
    line.run(milliseconds(100));
    line.is_silent = is_silent;
    line.garbage = 1;
    for (int i = 0; i < 1500; ++i) {
      line.host.command(line.now, 2.5, 0);  // the caller does not know
      line.step();
    }
    const double seconds = line.seconds();
    const double pan = line.unit.pan(seconds);
    EXPECT_GT(pan, 50);
    EXPECT_LT(pan, 1000);  // it would get to 2785
    EXPECT_EQ(line.unit.pan(seconds + 1), pan);
    line.is_silent = false;
    check_recovery(line);
  }
}

TEST(Halting, what_somebody_else_has_left_moving_is_halted) {
  Line line;
  line.unit.take(1, "ci pp2000 ");
  line.host.set_hold(milliseconds(200));
  line.begin();
  EXPECT_TRUE(line.asked.starts_with("- h ft ed ci pr ")) << line.asked;
  EXPECT_LT(line.unit.pan(9), 100);
}

TEST(Halting, a_halt_amid_the_first_questions_is_borne) {
  for (int late = 1; late < 100; late += 7) {
    Line line;
    line.host.set_hold(milliseconds(200));
    line.begin();
    line.host.command(line.now, 2, 0);
    line.run(milliseconds(200 - late));
    line.host.end();
    line.coming.clear();
    line.delay = milliseconds(30);
    line.host.begin(line.now);
    line.run(milliseconds(2000));
    EXPECT_TRUE(line.faults.empty()) << line.faults[0];
    EXPECT_LT(line.unit.pan(9), 400);
  }
}

TEST_F(Holding, a_halt_whose_answer_comes_when_it_is_ready_is_borne) {
  line.looks = false;
  line.host.command(line.now, 2, 0);
  line.run(milliseconds(50));
  line.host.take(line.now, "x\r\n");
  line.delay = milliseconds(150);
  line.run(milliseconds(1000));
  EXPECT_EQ(line.faults.size(), 1U) << line.asked;
  EXPECT_EQ(line.host.phase(), Phase::Ready);
  EXPECT_LT(line.unit.pan(9), 500);
}

}  // namespace
}  // namespace hc::pan_tilt
