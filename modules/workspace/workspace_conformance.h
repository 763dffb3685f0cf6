// SPDX-License-Identifier: Apache-2.0
#pragma once
// The rules of the focus (workspace.h) as tests see to them: from the bids and the decisions alone.

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "workspace.h"

/// Takes what is bid and decided, and expects that each decision keeps the rules.
class FocusRules {
 public:
  explicit FocusRules(const WorkspaceOptions& options = {}) : options_(options) {}

  void bid(std::int32_t mode, double salience, hc::MonotonicTime now) {
    tasks_[mode] = {salience, now + options_.expiry};
  }
  void bid_of_person(std::int32_t mode, double salience, hc::MonotonicTime now) {
    if (salience == 0 && mode != person_mode_) return;  // of another mode
    person_ = {salience, now + options_.person_expiry};
    person_mode_ = mode;
  }

  /// To be called for every decision, with the focus that it left.
  void decided(std::int32_t focus, hc::MonotonicTime now) {
    const bool is_held = person_.is_valid(now);
    const bool any = std::any_of(tasks_.begin(), tasks_.end(),
                                 [&](const auto& task) { return task.second.is_valid(now); });
    if (is_held) {
      EXPECT_EQ(focus, person_mode_);  // within one period
    } else {
      // An expired bid never holds focus; and none is in focus only where none bids.
      EXPECT_TRUE(focus == 0 ? !any : tasks_[focus].is_valid(now));
    }
    if (focus != focus_) {
      if (!is_held && tasks_[focus_].is_valid(now)) {  // so neither by expiry nor by a person
        EXPECT_GE(now - changed_, options_.dwell);
        EXPECT_GT(tasks_[focus].salience, tasks_[focus_].salience + options_.margin);
      }
      focus_ = focus;
      changed_ = now;
    }
    // Nobody is kept out behind the dwell time.
    if (is_held || !any || now - changed_ < options_.dwell) return;
    for (const auto& [mode, task] : tasks_) {
      if (!task.is_valid(now)) continue;
      EXPECT_LE(task.salience, tasks_[focus].salience + options_.margin);
    }
  }

 private:
  struct Bid {
    double salience = 0;
    hc::MonotonicTime expires{};

    [[nodiscard]] bool is_valid(hc::MonotonicTime now) const {
      return salience > 0 && now < expires;
    }
  };

  WorkspaceOptions options_;
  std::map<std::int32_t, Bid> tasks_;  // by mode
  Bid person_;
  std::int32_t person_mode_ = 0;
  std::int32_t focus_ = 0;
  hc::MonotonicTime changed_{};
};
