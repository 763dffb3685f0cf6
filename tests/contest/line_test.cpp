// SPDX-License-Identifier: Apache-2.0
// The contest for the focus to its end, the neck's serial line: three sources a mode bid, stop,
// guard, command and are silent at random, the workspace freezes, and the unit answers late. The
// neck gets commands of one source of the mode in focus, and none while no mode has it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>

#include <drivers/pan_tilt/neck.h>
#include <drivers/pan_tilt/pseudo_terminal_test.h>
#include <drivers/pan_tilt/unit.h>
#include <hc/module/focus.h>
#include <workspace/workspace.h>

namespace {

using hc::pan_tilt::Neck;
using std::chrono::milliseconds;

constexpr std::int32_t kTasks = 3, kSenders = 3;  // from 1 on
constexpr hc::Time kWall{std::chrono::seconds(1'700'000'000)};

/// A neck at its line, whose unit notes who has commanded it.
class NeckAtLine {
 public:
  NeckAtLine() {
    clock_.advance(milliseconds(1000));
    settings_.device = terminal_.path();
    settings_.hold = milliseconds(150);
    rest();
  }

  /// Time passes. @param focus  as the module has it. @param answers  the unit does.
  /// @returns  the mode of what was commanded on the line meanwhile; 0: nothing.
  std::int32_t step(milliseconds time, std::int32_t focus, bool answers) {
    clock_.advance(time);
    neck_.set_focus(focus);
    neck_.read();
    neck_.pass(settings_);
    const auto said = terminal_.read();
    answer_ += unit_.take(hc::seconds(now()), said);
    if (answers) terminal_.write(std::exchange(answer_, {}));
    if (said.find("h ") != std::string::npos) halted_ = now();
    return mode_of(said);
  }
  /// A second passes, in which no mode has the focus.
  void rest() {
    for (int i = 0; i < 100; ++i)
      EXPECT_EQ(step(milliseconds(10), 0, true), 0) << "commanded without any focus";
  }
  /// A command by whose pan the line tells the mode, and not twice the same. Whether it is obeyed.
  bool command(std::int32_t mode, std::int32_t source) {
    const auto before = dropped;
    const double pan = 0.5 * mode + 0.001 * (++number_ % 200);
    neck_.command(kWall, {pan, 0, kWall, mode, source});
    return dropped == before;
  }
  /// When it was halted on the line.
  [[nodiscard]] hc::MonotonicTime halted() const { return halted_; }

  [[nodiscard]] hc::MonotonicTime now() const { return clock_.monotonic(); }

  int dropped = 0;

 private:
  static std::int32_t mode_of(const std::string& said) {
    const auto at = said.find("pp");
    if (at == std::string::npos) return 0;
    EXPECT_EQ(said.find("pp", at + 1), std::string::npos);
    const double pan = std::stoi(said.substr(at + 2)) * 185.1428 / 3600 * M_PI / 180;
    return static_cast<std::int32_t>((pan + 0.1) / 0.5);
  }

  hc::pan_tilt::PseudoTerminal terminal_;
  hc::pan_tilt::Unit unit_;
  hc::pan_tilt::NeckSettings settings_;
  std::string answer_;
  hc::ManualClock clock_;
  Neck neck_{clock_, [](hc::Level, std::string_view) {}, [this](const auto&...) { ++dropped; },
             [](const auto&) {}};
  hc::MonotonicTime halted_{};
  int number_ = 0;
};

/// One random sequence.
class Sequence {
 public:
  Sequence(unsigned seed, NeckAtLine& neck) : random_(seed), neck_(neck) {}

  /// How often the neck was commanded.
  int run() {
    int commanded = 0;
    for (int ms = 0; ms < 300; ms += 2) {
      if (pick(0, 4) == 0) say();
      if (pick(0, 99) == 0) frozen_until_ = neck_.now() + milliseconds(pick(0, 250));
      if (ms % 10 == 0 && neck_.now() >= frozen_until_) decide();
      focus_.expire(neck_.now());
      if (pick(0, 2) == 0) command();
      if (pick(0, 29) == 0) answers_ = !answers_;
      const auto mode = neck_.step(milliseconds(2), focus_.current, answers_);
      if (mode == 0) continue;
      ++commanded;
      EXPECT_EQ(mode, focus_.current) << "the neck was commanded without the focus";
    }
    neck_.rest();
    return commanded;
  }

 private:
  int pick(int least, int most) { return std::uniform_int_distribution(least, most)(random_); }

  void say() {
    const Bidder who{pick(1, kTasks), pick(1, kSenders)};
    const double salience = pick(0, 4) == 0 ? 0 : 0.1 * pick(1, 10);
    const auto now = neck_.now();
    if (const int what = pick(0, 19); what < 12) {
      EXPECT_TRUE(workspace_.bid(who, salience, now, now));
    } else if (what < 17) {
      EXPECT_TRUE(workspace_.bid_of_person(who, salience, now, now));
    } else {
      const auto word = std::array{0, 0, 1, 2, 2, 3}.at(static_cast<std::size_t>(pick(0, 5)));
      EXPECT_TRUE(
          workspace_.brake.take({who.source, static_cast<std::uint8_t>(word), 0, now}, now));
    }
  }
  void decide() {
    workspace_.decide(neck_.now());
    focus_.current = workspace_.focus();
    focus_.received = neck_.now();
  }
  /// Of any mode and source, whoever has the focus. Another source of the same mode is obeyed only
  /// after a silence, or when the mode has changed.
  void command() {
    const Bidder who{pick(1, kTasks), pick(1, kSenders)};
    if (!focus_.admits(true, who.mode) || !neck_.command(who.mode, who.source)) return;
    if (who.mode == obeyed_.mode && who.source != obeyed_.source) {
      EXPECT_GE(neck_.now() - obeyed_at_, Neck::kTurn);
    }
    obeyed_ = who;
    obeyed_at_ = neck_.now();
  }

  std::minstd_rand random_;
  NeckAtLine& neck_;
  Workspace workspace_;
  hc::internal::Focus focus_;
  hc::MonotonicTime frozen_until_{};
  bool answers_ = true;
  Bidder obeyed_;
  hc::MonotonicTime obeyed_at_{};
};

TEST(Line, in_random_sequences_only_who_has_the_focus_commands_the_neck) {
  NeckAtLine neck;
  int commanded = 0;
  for (unsigned seed = 1; seed <= 2'000; ++seed) {
    SCOPED_TRACE(seed);
    commanded += Sequence(seed, neck).run();
    ASSERT_FALSE(testing::Test::HasFailure());
  }
  EXPECT_GT(commanded, 2'000);
  EXPECT_GT(neck.dropped, 2'000);
}

TEST(Line, the_neck_halts_within_a_fifth_of_a_second_of_the_last_focus) {
  NeckAtLine neck;
  hc::internal::Focus focus;
  focus.current = 1;
  focus.received = neck.now();
  const auto last = neck.now();
  hc::MonotonicTime commanded{};
  for (int ms = 0; ms < 400; ++ms) {  // whoever commands does not know
    focus.expire(neck.now());
    if (focus.admits(true, 1)) neck.command(1, 1);
    if (neck.step(milliseconds(1), focus.current, true) != 0) commanded = neck.now();
  }
  EXPECT_GT(neck.halted(), commanded);
  EXPECT_LE(neck.halted() - last, milliseconds(130));
}

}  // namespace
