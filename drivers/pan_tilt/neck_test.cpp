// SPDX-License-Identifier: Apache-2.0
#include <drivers/pan_tilt/neck.h>

#include <functional>
#include <utility>
#include <vector>

#include <drivers/pan_tilt/pseudo_terminal_test.h>
#include <drivers/pan_tilt/unit.h>

namespace hc::pan_tilt {
namespace {

using std::chrono::milliseconds;
using Phase = Conversation::Phase;

/// A manual clock after whose next reading the process waits.
class WaitingClock final : public Clock {
 public:
  [[nodiscard]] MonotonicTime monotonic() const override {
    const auto time = manual_.monotonic();
    if (wait) std::exchange(wait, {})();
    return time;
  }
  [[nodiscard]] Time wall() const override { return manual_.wall(); }
  void advance(std::chrono::nanoseconds by) { manual_.advance(by); }

  mutable std::function<void()> wait;

 private:
  ManualClock manual_;
};

/// A neck with a manual clock, and a unit on a pseudo-terminal.
class NeckTest : public ::testing::Test {
 protected:
  void run(milliseconds duration) {
    for (const auto end = now() + duration; now() < end;) {
      clock_.advance(milliseconds(1));
      if (terminal_) {
        const auto said =
            unit_.take(std::chrono::duration<double>(now()).count(), terminal_->read());
        if (!is_silent_) terminal_->write(said);
      }
      neck_.read();
      neck_.pass(settings_);
      if (now().count() % 20'000'000 == 0) neck_.look();
    }
  }
  void plug() { terminal_.emplace(); }
  void begin(milliseconds within = milliseconds(100)) {
    plug();
    settings_.device = path();
    run(within);
  }
  void command(double pan, double tilt) { neck_.command(kWall, {pan, tilt, kWall}); }
  [[nodiscard]] std::string path() const { return terminal_->path(); }

  static constexpr Time kWall{std::chrono::seconds(1'700'000'000)};
  NeckTest() { clock_.advance(milliseconds(1000)); }
  [[nodiscard]] MonotonicTime now() const { return clock_.monotonic(); }

  WaitingClock clock_;
  std::optional<PseudoTerminal> terminal_;
  Unit unit_;
  bool is_silent_ = false;
  NeckSettings settings_;
  std::vector<std::string> log_, problems_;
  std::vector<Gaze> seen_;
  Neck neck_{clock_, [this](Level, std::string_view line) { log_.emplace_back(line); },
             [this](const std::string& kind, std::string_view line) {
               problems_.push_back(kind + ": " + std::string(line));
             },
             [this](const Gaze& gaze) { seen_.push_back(gaze); }};
};

TEST_F(NeckTest, an_answer_that_comes_while_the_process_waits_is_of_then) {
  begin();
  run(milliseconds(100));
  seen_.clear();
  const auto asked = now();
  neck_.look();
  clock_.advance(milliseconds(1));
  clock_.wait = [this] {
    clock_.advance(milliseconds(40));
    terminal_->write(unit_.take(std::chrono::duration<double>(now()).count(), terminal_->read()));
  };
  neck_.read();
  neck_.pass(settings_);
  ASSERT_EQ(seen_.size(), 1U);
  // Its question was on the line at 960 bytes a second first.
  EXPECT_GE(seen_[0].time - asked, milliseconds(2));
}

TEST_F(NeckTest, finds_the_unit_commands_it_and_says_where_it_looks) {
  begin();
  command(0.5, 0.1);
  run(milliseconds(1000));
  EXPECT_TRUE(problems_.empty());
  ASSERT_FALSE(seen_.empty());
  EXPECT_NEAR(seen_.back().pan, 0.5, 0.001);
  EXPECT_NEAR(seen_.back().tilt, 0.1, 0.001);
  EXPECT_NEAR(unit_.pan(9), 557, 0.5);
  EXPECT_NEAR(unit_.tilt(9), -111, 0.5);
  EXPECT_EQ(log_, std::vector<std::string>{
                      path() +
                      ": pan from -158.9 to 158.9, tilt from -31.1 (up) to 46.6 (down) degrees"});
}

TEST_F(NeckTest, logs_once_that_there_is_no_device_and_retries) {
  settings_.device = "/no/such/device";
  run(milliseconds(10'000));
  EXPECT_EQ(log_, std::vector<std::string>{"/no/such/device: open: No such file or directory"});
}

TEST_F(NeckTest, a_name_that_does_not_stay_is_to_be_set_again) {
  plug();
  neck_.set_device(path());
  run(milliseconds(100));
  const std::string old = path();
  terminal_.reset();
  run(milliseconds(100));
  EXPECT_EQ(neck_.descriptor(), -1);
  plug();  // it may get the same number
  run(milliseconds(5000));
  EXPECT_EQ(neck_.descriptor(), -1);
  neck_.set_device(path());
  run(milliseconds(1500));
  ASSERT_EQ(log_.size(), 3U);
  EXPECT_EQ(log_[1], old + ": disconnected");
  EXPECT_EQ(log_[2], path() + ": reconnected");
}

TEST_F(NeckTest, a_device_that_was_set_counts_until_the_setting_changes) {
  settings_.device = "/no/such/device";
  run(milliseconds(100));
  plug();
  neck_.set_device(path());
  run(milliseconds(100));
  EXPECT_GE(neck_.descriptor(), 0);
  settings_.device = "";
  run(milliseconds(100));
  EXPECT_EQ(neck_.descriptor(), -1);
  EXPECT_EQ(log_.back(), path() + ": removed");
}

TEST_F(NeckTest, drops_commands_that_are_too_old_or_cannot_be_obeyed) {
  begin();
  neck_.command(kWall, {0.5, 0, {}});
  neck_.command(kWall, {0.5, 0, kWall - milliseconds(201)});
  neck_.command(kWall, {0.5, 0, kWall + milliseconds(300)});
  run(milliseconds(1000));
  EXPECT_EQ(unit_.pan(9), 0);
  neck_.command(kWall, {0.5, 0, kWall - milliseconds(199)});
  run(milliseconds(1000));
  EXPECT_NEAR(unit_.pan(9), 557, 0.5);
  neck_.command(kWall, {0, 0, kWall + milliseconds(199)});
  run(milliseconds(1000));
  EXPECT_NEAR(unit_.pan(9), 0, 0.5);
  neck_.leave();
  command(0, 0);
  EXPECT_EQ(problems_,
            (std::vector<std::string>{"without a time: command dropped: no time",
                                      "stale: command dropped: 0.201 s old",
                                      "stale: command dropped: 0.300 s in the future",
                                      "no unit: command dropped: pan-tilt unit not connected"}));
}

TEST_F(NeckTest, obeys_one_source_of_a_mode_at_a_time_and_another_mode_at_once) {
  begin();
  auto say = [&](std::int32_t mode, std::int32_t source, double pan) {
    neck_.command(kWall, {pan, 0, kWall, mode, source});
    run(milliseconds(20));
  };
  for (int i = 0; i < 50; ++i) {  // two contradicting sources
    say(1, 5, 0.5);
    say(1, 6, -0.5);
  }
  EXPECT_NEAR(unit_.pan(9), 557, 0.5);
  EXPECT_EQ(problems_.front(),
            "second source: command of source 6 dropped: source 5 is in control");
  say(2, 6, -0.25);
  EXPECT_NEAR(unit_.pan(9), -278, 1);
  run(Neck::kTurn + milliseconds(1));
  say(2, 5, 0.25);
  EXPECT_NEAR(unit_.pan(9), 278, 1);
}

TEST_F(NeckTest, halts_when_no_mode_has_the_focus_and_obeys_again) {
  settings_.hold = milliseconds(0);
  begin();
  neck_.set_focus(7);
  command(2, 0);
  run(milliseconds(100));
  command(1, 0);
  command(0.5, 0);  // waits for the answer to the one before
  neck_.set_focus(0);
  run(milliseconds(1000));
  const double pan = unit_.pan(9);
  EXPECT_GT(pan, 10);
  EXPECT_LT(pan, 400);
  EXPECT_EQ(unit_.pan(10), pan);
  run(milliseconds(1000));
  neck_.set_focus(7);
  command(2, 0);
  run(milliseconds(3000));
  EXPECT_NEAR(unit_.pan(9), 2228, 1);
}

TEST_F(NeckTest, a_command_that_has_waited_lives_for_the_rest_of_its_age) {
  begin();
  command(1, 0);
  neck_.command(kWall, {0.5, 0, kWall - milliseconds(150)});  // waits for the first one's answer
  clock_.advance(milliseconds(60));
  neck_.pass(settings_);
  run(milliseconds(1000));
  EXPECT_NEAR(unit_.pan(9), 1114, 0.5);
}

TEST_F(NeckTest, a_silent_unit_is_logged_once_and_so_is_its_return) {
  begin();
  log_.clear();
  is_silent_ = true;
  run(milliseconds(20'000));
  EXPECT_EQ(log_, (std::vector<std::string>{path() + ": no answer from the unit for 0.5 s",
                                            path() + ": reopening"}));
  log_.clear();
  is_silent_ = false;
  run(milliseconds(5000));
  EXPECT_EQ(log_, std::vector<std::string>{path() + ": reconnected"});
}

TEST_F(NeckTest, an_answer_that_came_while_nothing_was_read_is_no_silence) {
  begin(milliseconds(1500));
  log_.clear();
  neck_.look();
  terminal_->write(unit_.take(2.6, terminal_->read()));
  clock_.advance(milliseconds(1000));  // the process was stopped meanwhile
  neck_.pass(settings_);
  run(milliseconds(1000));
  EXPECT_TRUE(log_.empty()) << log_[0];
}

TEST_F(NeckTest, a_new_rate_reopens_the_line) {
  begin();
  settings_.baud = 38400;
  run(milliseconds(1500));
  EXPECT_EQ(log_.back(), path() + ": reconnected");
}

TEST_F(NeckTest, halts_what_it_has_begun_when_it_leaves) {
  begin();
  command(2, 0);
  run(milliseconds(20));
  neck_.leave();
  EXPECT_NE(terminal_->read().find("h "), std::string::npos);
  EXPECT_EQ(neck_.descriptor(), -1);
}

}  // namespace
}  // namespace hc::pan_tilt
