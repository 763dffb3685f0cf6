// SPDX-License-Identifier: Apache-2.0
#include "workspace.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "workspace_conformance.h"

namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPeriod{50};

/// A workspace and its clock.
struct Table {
  Workspace workspace;
  hc::MonotonicTime now{milliseconds(1000)};

  void bid(std::int32_t mode, double salience) {
    ASSERT_TRUE(workspace.bid(mode, salience, now).has_value());
  }
  void person(std::int32_t mode, double salience) {
    ASSERT_TRUE(workspace.bid_of_person(mode, salience, now).has_value());
  }
  /// The focus after so long.
  std::int32_t after(milliseconds wait) {
    now += wait;
    workspace.decide(now);
    return workspace.focus();
  }
};

TEST(Workspace, the_greatest_bid_has_the_focus_and_none_is_0) {
  Table table;
  EXPECT_EQ(table.after(kPeriod), 0);
  table.bid(1, 0.2);
  table.bid(3, 0.9);
  table.bid(2, 0.9);
  EXPECT_EQ(table.after(kPeriod), 2);  // of equal ones the lowest
  table.bid(2, 0);
  EXPECT_EQ(table.after(kPeriod), 3);
  EXPECT_EQ(table.after(milliseconds(1000)), 0);
}

TEST(Workspace, nobody_has_the_focus_while_it_is_stopped) {
  Table table;
  table.bid(1, 0.5);
  EXPECT_EQ(table.after(kPeriod), 1);
  table.workspace.stop(true);
  table.person(2, 1);
  EXPECT_EQ(table.after(milliseconds(0)), 0);
  EXPECT_EQ(table.workspace.last_change({}), "none; stopped");
  table.workspace.stop(false);
  EXPECT_EQ(table.after(milliseconds(0)), 2);
}

TEST(Workspace, a_challenger_needs_the_margin_and_waits_for_the_dwell_time) {
  Table table;
  table.bid(1, 0.5);
  EXPECT_EQ(table.after(milliseconds(0)), 1);
  auto at = [&](int ms, double challenge) {
    table.bid(1, 0.5);
    table.bid(2, challenge);
    return table.after(milliseconds(ms));
  };
  EXPECT_EQ(at(999, 0.9), 1);
  EXPECT_EQ(at(1, 0.55), 1);
  EXPECT_EQ(at(0, 0.9), 2);
}

TEST(Workspace, an_expired_bid_loses_the_focus_within_its_dwell_time) {
  WorkspaceOptions options;
  options.dwell = milliseconds(5000);
  Table table{Workspace(options)};
  table.bid(1, 0.9);
  EXPECT_EQ(table.after(milliseconds(500)), 1);
  table.bid(2, 0.1);
  EXPECT_EQ(table.after(milliseconds(499)), 1);
  EXPECT_EQ(table.after(milliseconds(1)), 2);
  EXPECT_EQ(table.after(milliseconds(500)), 0);
}

TEST(Workspace, a_person_is_above_all_until_released_or_expired) {
  Table table;
  table.bid(1, 1);
  EXPECT_EQ(table.after(kPeriod), 1);
  table.person(2, 0.01);
  EXPECT_EQ(table.after(milliseconds(0)), 2);
  table.person(3, 0.01);
  EXPECT_EQ(table.after(milliseconds(0)), 3);
  table.person(2, 0);  // of what another hand does not want
  EXPECT_EQ(table.after(milliseconds(0)), 3);
  table.person(3, 0);
  EXPECT_EQ(table.after(milliseconds(0)), 1);
  table.person(2, 1);
  EXPECT_EQ(table.after(milliseconds(59999)), 2);
  EXPECT_EQ(table.after(milliseconds(1)), 0);
}

TEST(Workspace, standings_tell_each_mode_that_bids) {
  Table table;
  table.bid(4, 0.25);
  table.bid(2, 0.5);
  table.person(3, 1);
  table.after(milliseconds(100));
  auto rows = table.workspace.standings(table.now);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].mode, 2);
  EXPECT_EQ(rows[0].salience, 0.5);
  EXPECT_EQ(rows[0].age, milliseconds(100));
  EXPECT_FALSE(rows[0].in_focus || rows[0].is_of_person);
  EXPECT_EQ(rows[1].mode, 3);
  EXPECT_TRUE(rows[1].in_focus && rows[1].is_of_person);
  EXPECT_EQ(rows[2].mode, 4);
}

TEST(Workspace, a_change_of_focus_tells_the_bids_behind_it) {
  Table table;
  const std::map<std::int32_t, std::string> names = {{1, "track"}, {2, "read"}};
  auto change = [&] { return table.workspace.last_change(names); };
  table.bid(1, 0.4);
  EXPECT_EQ(table.after(kPeriod), 1);
  EXPECT_EQ(change(), "track (0.40)");
  table.after(milliseconds(900));
  table.bid(1, 0.4);
  table.bid(2, 0.6);
  EXPECT_EQ(table.after(milliseconds(100)), 2);
  EXPECT_EQ(change(), "read (0.60) over track (0.40), margin 0.10");
  table.bid(2, 0);
  EXPECT_EQ(table.after(milliseconds(0)), 1);
  EXPECT_EQ(change(), "track (0.40); no bid of read");
  table.person(3, 1);
  EXPECT_EQ(table.after(milliseconds(0)), 3);
  EXPECT_EQ(change(), "mode 3 (a person's bid) over track (0.40)");
  EXPECT_EQ(table.after(milliseconds(70000)), 0);
  EXPECT_EQ(change(), "none; no bid is left");
}

TEST(Workspace, bids_that_make_no_sense_are_counted_and_change_nothing) {
  Table table;
  table.bid(1, 0.5);
  for (double salience : {std::nan(""), -0.1, 1.1, std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(table.workspace.bid(1, salience, table.now).has_value());
    EXPECT_FALSE(table.workspace.bid_of_person(2, salience, table.now).has_value());
  }
  EXPECT_FALSE(table.workspace.bid(0, 0.5, table.now).has_value());
  EXPECT_FALSE(table.workspace.bid(-1, 0.5, table.now).has_value());
  EXPECT_EQ(table.after(kPeriod), 1);
  for (std::int32_t mode = 2; mode <= static_cast<std::int32_t>(Workspace::kMostModes); ++mode)
    table.bid(mode, 0.1);
  EXPECT_FALSE(table.workspace.bid(5000, 0.5, table.now).has_value());
  table.bid(2, 0.2);  // has one already
  EXPECT_EQ(table.workspace.refused().salience, 8);
  EXPECT_EQ(table.workspace.refused().mode, 2);
  EXPECT_EQ(table.workspace.refused().crowded, 1);
  EXPECT_EQ(table.workspace.refused().total(), 11);
}

/// One random sequence of bids, with what must hold at each period.
class Sequence {
 public:
  explicit Sequence(unsigned seed) : random_(seed) {
    options_.margin = 0.05 * pick(0, 4);
    options_.dwell = milliseconds(100 * pick(0, 12));
    options_.expiry = milliseconds(100 * pick(1, 12));
    options_.person_expiry = milliseconds(100 * pick(1, 20));
    workspace_ = Workspace(options_);
    rules_ = FocusRules(options_);
  }

  void run() {
    for (int period = 0; period < 60; ++period) {
      for (int bids = pick(0, 3); bids > 0; --bids) bid();
      now_ += milliseconds(pick(0, 1) != 0 ? 50 : pick(0, 60));
      decide();
    }
  }

 private:
  int pick(int least, int most) { return std::uniform_int_distribution(least, most)(random_); }

  void bid() {
    now_ += milliseconds(pick(0, 10));
    auto mode = pick(1, 4);
    double salience = pick(0, 9) == 0 ? 0 : 0.01 * pick(1, 100);
    if (pick(0, 19) == 0) {
      ASSERT_TRUE(workspace_.bid_of_person(mode, salience, now_).has_value());
      rules_.bid_of_person(mode, salience, now_);
    } else if (pick(0, 19) == 0) {
      EXPECT_FALSE(workspace_.bid(mode, -salience - 0.1, now_).has_value());
    } else {
      ASSERT_TRUE(workspace_.bid(mode, salience, now_).has_value());
      rules_.bid(mode, salience, now_);
    }
  }

  void decide() {
    const std::int32_t before = workspace_.focus();
    const bool changed = workspace_.decide(now_);
    EXPECT_EQ(changed, workspace_.focus() != before);
    rules_.decided(workspace_.focus(), now_);
  }

  std::minstd_rand random_;
  WorkspaceOptions options_;
  Workspace workspace_;
  FocusRules rules_;
  hc::MonotonicTime now_{0};
};

TEST(Workspace, ten_thousand_random_sequences_keep_the_rules) {
  for (unsigned seed = 1; seed <= 10'000; ++seed) {
    SCOPED_TRACE(seed);
    Sequence(seed).run();
    ASSERT_FALSE(testing::Test::HasFailure());
  }
}

}  // namespace
