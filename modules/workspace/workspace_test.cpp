// SPDX-License-Identifier: Apache-2.0
#include "workspace.h"

#include <array>
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

  void bid(std::int32_t mode, double salience, std::int32_t source = 1) {
    ASSERT_TRUE(workspace.bid({mode, source}, salience, now, now).has_value());
  }
  void person(std::int32_t mode, double salience, std::int32_t source = 1) {
    ASSERT_TRUE(workspace.bid_of_person({mode, source}, salience, now, now).has_value());
  }
  void stop(std::uint8_t word, std::int32_t source = 1) {
    ASSERT_TRUE(workspace.brake.take({source, word, 0, now}, now).has_value());
  }
  /// The focus after this time.
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
  EXPECT_EQ(table.after(kPeriod), 2);  // the lowest of equal ones
  table.bid(2, 0);
  EXPECT_EQ(table.after(kPeriod), 3);
  EXPECT_EQ(table.after(milliseconds(1000)), 0);
}

TEST(Workspace, nobody_has_the_focus_while_it_is_stopped) {
  Table table;
  table.bid(1, 0.5);
  EXPECT_EQ(table.after(kPeriod), 1);
  table.stop(1, 12);
  table.person(2, 1);
  EXPECT_EQ(table.after(milliseconds(0)), 0);
  EXPECT_EQ(table.workspace.last_change(), "none; stopped by source 12");
  table.stop(0, 13);
  EXPECT_EQ(table.after(milliseconds(0)), 0);
  table.stop(0, 12);
  EXPECT_EQ(table.after(milliseconds(0)), 2);
}

TEST(Workspace, nobody_has_the_focus_while_who_guards_is_silent) {
  Table table;
  for (int i = 0; i < 2; ++i) table.stop(0, 12);
  auto later = [&](int ms) {
    table.bid(1, 0.5);
    return table.after(milliseconds(ms));
  };
  EXPECT_EQ(later(300), 1);
  EXPECT_EQ(later(1), 0);
  EXPECT_EQ(table.workspace.last_change(), "none; source 12 is silent: its stop could not arrive");
  table.stop(0, 12);
  EXPECT_EQ(later(0), 1);
}

TEST(Workspace, a_source_withdraws_its_own_bid_and_no_other) {
  Table table;
  for (auto bid : {&Table::bid, &Table::person}) {
    (table.*bid)(2, 1, 1);
    (table.*bid)(2, 0, 2);
    EXPECT_EQ(table.after(kPeriod), 2);
    (table.*bid)(2, 0.5, 2);
    (table.*bid)(2, 0, 1);
    EXPECT_EQ(table.after(kPeriod), 2);
    EXPECT_EQ(table.workspace.standings(table.now).at(0).salience, 0.5);
    (table.*bid)(2, 0, 2);
    EXPECT_EQ(table.after(kPeriod), 0);
  }
}

TEST(Workspace, a_mode_has_the_greatest_bid_of_its_sources_and_each_expires_alone) {
  WorkspaceOptions options;
  options.dwell = milliseconds(0);
  Table table{Workspace(options)};
  table.bid(1, 0.9, 1);
  table.after(milliseconds(500));
  table.bid(1, 0.3, 2);
  table.bid(2, 0.5, 3);
  EXPECT_EQ(table.after(milliseconds(499)), 1);
  EXPECT_EQ(table.workspace.standings(table.now).at(0).salience, 0.9);
  EXPECT_EQ(table.after(milliseconds(1)), 2);  // 0.3 of mode 1 is left
}

TEST(Workspace, persons_who_contradict_each_other_do_not_take_turns) {
  for (double other : {1.0, 0.9}) {
    Table table;
    int changes = 0;
    for (int i = 0; i < 1000; ++i) {
      table.person(2, 1, 1);
      if (i >= 10) table.person(3, other, 2);
      const auto before = table.workspace.focus();
      changes += table.after(milliseconds(20)) != before ? 1 : 0;
    }
    EXPECT_EQ(table.workspace.focus(), 2);
    EXPECT_EQ(changes, 1);
    table.person(2, 0, 1);
    EXPECT_EQ(table.after(kPeriod), 3);
  }
}

TEST(Workspace, of_persons_the_greater_wins_and_of_new_ones_the_last_to_begin) {
  Table table;
  table.person(2, 0.5, 1);
  table.after(kPeriod);
  table.person(3, 0.6, 2);
  EXPECT_EQ(table.after(kPeriod), 3);
  table.stop(1);
  table.person(2, 0.6, 1);  // started earlier
  EXPECT_EQ(table.after(kPeriod), 0);
  table.stop(0);
  EXPECT_EQ(table.after(kPeriod), 3);
  table.person(2, 0, 1);
  table.after(kPeriod);
  table.stop(1);
  table.person(2, 0.6, 1);
  table.after(kPeriod);
  table.person(3, 0.6, 2);  // a repetition
  table.stop(0);
  EXPECT_EQ(table.after(kPeriod), 2);
}

TEST(Workspace, a_bid_counts_from_when_it_was_made_and_not_outside_its_time) {
  Table table;
  auto made = [&](auto ago) {
    return table.workspace.bid({1, 1}, 0.5, table.now - ago, table.now).has_value();
  };
  for (auto ago : {std::chrono::hours(1), std::chrono::hours(-1), std::chrono::hours(490'000)})
    EXPECT_FALSE(made(ago));
  EXPECT_FALSE(made(milliseconds(1000)));
  EXPECT_FALSE(made(milliseconds(-201)));
  EXPECT_EQ(table.after(kPeriod), 0);
  EXPECT_EQ(table.workspace.refused().time, 5);
  EXPECT_TRUE(made(milliseconds(900)));
  EXPECT_EQ(table.after(milliseconds(99)), 1);
  EXPECT_EQ(table.after(milliseconds(1)), 0);
  EXPECT_TRUE(made(milliseconds(-200)));
  EXPECT_EQ(table.after(milliseconds(999)), 1);
  EXPECT_EQ(table.after(milliseconds(1)), 0);
}

TEST(Workspace, only_modes_of_the_graph_may_have_bids) {
  Table table;
  table.workspace.set_modes({{1, "track"}, {2, "read"}});
  table.bid(2, 0.5);
  EXPECT_FALSE(table.workspace.bid({3, 1}, 0.9, table.now, table.now));
  EXPECT_FALSE(table.workspace.bid_of_person({3, 1}, 1, table.now, table.now));
  EXPECT_EQ(table.after(kPeriod), 2);
  EXPECT_EQ(table.workspace.refused().mode, 2);
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
  table.person(3, 0.02);
  EXPECT_EQ(table.after(milliseconds(0)), 3);
  table.person(2, 0);
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
  table.workspace.set_modes({{1, "track"}, {2, "read"}, {3, "point"}});
  auto change = [&] { return table.workspace.last_change(); };
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
  EXPECT_EQ(change(), "point (a person's bid) over track (0.40)");
  EXPECT_EQ(table.after(milliseconds(70000)), 0);
  EXPECT_EQ(change(), "none; no bid is left");
}

TEST(Workspace, bids_that_make_no_sense_are_counted_and_change_nothing) {
  Table table;
  table.bid(1, 0.5);
  for (double salience : {std::nan(""), -0.1, 1.1, std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(table.workspace.bid({1, 1}, salience, table.now, table.now));
    EXPECT_FALSE(table.workspace.bid_of_person({2, 1}, salience, table.now, table.now));
  }
  EXPECT_FALSE(table.workspace.bid({0, 1}, 0.5, table.now, table.now));
  EXPECT_FALSE(table.workspace.bid({-1, 1}, 0.5, table.now, table.now));
  EXPECT_EQ(table.after(kPeriod), 1);
  for (std::int32_t mode = 2; mode <= static_cast<std::int32_t>(Workspace::kMostModes); ++mode)
    table.bid(mode, 0.1);
  EXPECT_FALSE(table.workspace.bid({5000, 1}, 0.5, table.now, table.now));
  table.bid(2, 0.2);  // has one already
  for (std::int32_t source = 2; source <= static_cast<std::int32_t>(Workspace::kMostSources);
       ++source)
    table.bid(2, 0.1, source);
  EXPECT_FALSE(table.workspace.bid({2, 5000}, 0.5, table.now, table.now));
  EXPECT_EQ(table.workspace.refused().salience, 8);
  EXPECT_EQ(table.workspace.refused().mode, 2);
  EXPECT_EQ(table.workspace.refused().crowded, 2);
  EXPECT_EQ(table.workspace.refused().total(), 12);
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

  /// A bid or a stop of one of three sources.
  void bid() {
    now_ += milliseconds(pick(0, 10));
    const Bidder who{pick(1, 4), pick(1, 3)};
    // Few different numbers, so that some are equal.
    const double salience = pick(0, 5) == 0 ? 0 : 0.1 * pick(1, 10);
    const auto which = pick(0, 19);
    if (which < 6) {
      ASSERT_TRUE(workspace_.bid_of_person(who, salience, now_, now_));
      rules_.bid_of_person(who, salience, now_);
    } else if (which == 6) {
      EXPECT_FALSE(workspace_.bid(who, -salience - 0.1, now_, now_));
      EXPECT_FALSE(workspace_.bid(who, salience, now_ - std::chrono::hours(1), now_));
    } else if (which < 9) {
      const auto word = static_cast<std::uint8_t>(
          std::array{0, 0, 0, 1, 2, 2, 3}.at(static_cast<std::size_t>(pick(0, 6))));
      const Brake::Message message{who.source, word, 0, now_};
      ASSERT_TRUE(workspace_.brake.take(message, now_));
      rules_.stop(message, now_);
    } else {
      ASSERT_TRUE(workspace_.bid(who, salience, now_, now_));
      rules_.bid(who, salience, now_);
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
