// SPDX-License-Identifier: Apache-2.0
#pragma once
// The rules of the focus (workspace.h) as tests see to them: from the bids and the decisions alone.

#include <algorithm>
#include <map>
#include <utility>

#include <gtest/gtest.h>

#include "workspace.h"

/// Takes what is bid, said to the brake and decided, and expects that each decision keeps the
/// rules.
class FocusRules {
 public:
  explicit FocusRules(const WorkspaceOptions& options = {}) : options_(options) {}

  void bid(const Bidder& who, double salience, hc::MonotonicTime now) {
    take(who, salience, now, tasks_, options_.expiry);
  }
  void bid_of_person(const Bidder& who, double salience, hc::MonotonicTime now) {
    take(who, salience, now, persons_, options_.person_expiry);
  }
  /// What is said to the brake, whose rules are tested by themselves.
  void stop(const Brake::Message& message, hc::MonotonicTime now) {
    EXPECT_TRUE(brake_.take(message, now));
  }

  /// To be called for every decision, with the focus that it left.
  void decided(std::int32_t focus, hc::MonotonicTime now) {
    auto tasks = best(tasks_, now), persons = best(persons_, now);
    if (!brake_.reason(now).empty()) {
      EXPECT_EQ(focus, 0);
    } else if (!persons.empty()) {
      decided_by_persons(persons, focus);
    } else {
      decided_by_tasks(tasks, focus, now);
    }
    if (focus != focus_) changed_ = now;
    focus_ = focus;
  }

 private:
  struct Bid {
    double salience = 0;
    hc::MonotonicTime expires{}, began{};
    [[nodiscard]] bool is_valid(hc::MonotonicTime now) const {
      return salience > 0 && now < expires;
    }
  };
  using Bids = std::map<std::pair<std::int32_t, std::int32_t>, Bid>;  // by mode and source
  using Best = std::map<std::int32_t, Bid>;                           // by mode

  static void take(const Bidder& who, double salience, hc::MonotonicTime now, Bids& bids,
                   std::chrono::nanoseconds expiry) {
    Bid& bid = bids[{who.mode, who.source}];
    bid = {salience, now + expiry, bid.is_valid(now) ? bid.began : now};
  }

  /// The greatest valid bid of each mode, of equal ones that which began last.
  static Best best(const Bids& bids, hc::MonotonicTime now) {
    Best best;
    for (const auto& [who, bid] : bids) {
      if (!bid.is_valid(now)) continue;
      Bid& most = best[who.first];
      if (bid.salience > most.salience || (bid.salience == most.salience && bid.began > most.began))
        most = bid;
    }
    return best;
  }

  /// No person bids more than the one in focus; of equal bids it has kept the focus, or is the
  /// earliest.
  void decided_by_persons(const Best& persons, std::int32_t focus) const {
    ASSERT_TRUE(persons.contains(focus)) << focus;
    const Bid& granted = persons.at(focus);
    for (const auto& [mode, bid] : persons) {
      EXPECT_LE(bid.salience, granted.salience);
      if (bid.salience < granted.salience || mode == focus || focus == focus_) continue;
      EXPECT_NE(mode, focus_) << "the focus was taken by a bid that is no greater";
      EXPECT_LE(bid.began, granted.began);
    }
  }

  void decided_by_tasks(Best& tasks, std::int32_t focus, hc::MonotonicTime now) const {
    // An expired bid never holds focus; and none is in focus only where none bids.
    EXPECT_TRUE(focus == 0 ? tasks.empty() : tasks.contains(focus)) << focus;
    if (focus != focus_ && tasks.contains(focus_)) {  // so not by expiry
      EXPECT_GE(now - changed_, options_.dwell);
      EXPECT_GT(tasks[focus].salience, tasks[focus_].salience + options_.margin);
    }
    // After the dwell time a higher bid has the focus.
    if (focus != focus_ || now - changed_ < options_.dwell) return;
    for (const auto& [mode, bid] : tasks)
      EXPECT_LE(bid.salience, tasks[focus].salience + options_.margin);
  }

  WorkspaceOptions options_;
  Bids tasks_, persons_;
  Brake brake_;
  std::int32_t focus_ = 0;
  hc::MonotonicTime changed_{};
};
