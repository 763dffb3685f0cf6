// SPDX-License-Identifier: Apache-2.0
#pragma once
// Which mode has the focus: tasks bid with a salience each, one wins. Pure: time is handed in and
// never goes back.
//
// The rules, judged by decide() and at no other time:
// - A bid is valid until it expires, or the next of its mode replaces it. One of salience 0
// withdraws
//   it, as if it expired then.
// - While the mode in focus has a bid, a challenger takes focus with a salience that is greater by
//   more than the margin, when the focus has been where it is for the dwell time.
// - A focus whose bid has ended goes at once, within its dwell time too, to the greatest bid, of
//   equal ones to that of the lowest mode; when there is none, to 0: none.
// - A person's bid is above all others: it has the focus whatever the dwell time and margin say,
//   until it expires or is withdrawn. The last one counts.
// - While it is stopped no mode has the focus. Bids are taken meanwhile.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <hc/base/clock.h>
#include <hc/base/result.h>

struct WorkspaceOptions {
  double margin = 0.1;  ///< of salience
  std::chrono::nanoseconds dwell{1'000'000'000};
  std::chrono::nanoseconds expiry{1'000'000'000};
  std::chrono::nanoseconds person_expiry{60'000'000'000};  ///< of a person's bid
};

/// The state of a mode.
struct Standing {
  std::int32_t mode = 0;
  double salience = 0;             ///< the person's where the bid is a person's
  std::chrono::nanoseconds age{};  ///< since the bid was made
  bool in_focus = false;
  bool is_of_person = false;
};

/// Bids that were refused, by reason.
struct Refused {
  std::int64_t salience = 0;  ///< not a number, or not from 0 to 1
  std::int64_t mode = 0;      ///< 0 or below
  std::int64_t crowded = 0;   ///< kMostModes have bids already

  [[nodiscard]] std::int64_t total() const { return salience + mode + crowded; }
};

class Workspace {
 public:
  /// Modes that may have bids at the same time.
  static constexpr std::size_t kMostModes = 1024;

  explicit Workspace(const WorkspaceOptions& options = {}) : options_(options) {}

  void set_options(const WorkspaceOptions& options) { options_ = options; }

  /// A task's bid. @param salience  0 … 1; 0 withdraws.
  ///
  /// Errors: Malformed; the bid is counted as refused and changes nothing.
  hc::Status bid(std::int32_t mode, double salience, hc::MonotonicTime now);

  /// A person's bid, in the same way; its salience matters only in that 0 withdraws it,
  /// and no other mode's.
  hc::Status bid_of_person(std::int32_t mode, double salience, hc::MonotonicTime now);

  /// Stops all tasks until it is called with false.
  void stop(bool is_stopped) { is_stopped_ = is_stopped; }
  [[nodiscard]] bool is_stopped() const { return is_stopped_; }

  /// Applies the rules; true when the focus has changed. To be called each period.
  bool decide(hc::MonotonicTime now);

  /// The last change of focus and the bids behind it: "track (0.60) over read (0.40), margin 0.10".
  /// @param names  of modes; those that have none are named by their numbers.
  [[nodiscard]] std::string last_change(const std::map<std::int32_t, std::string>& names) const;

  /// The mode in focus as decide() left it; 0: none.
  [[nodiscard]] std::int32_t focus() const { return focus_; }

  /// Modes that had a bid when decide() was called, and those that came since, by their numbers.
  [[nodiscard]] std::vector<Standing> standings(hc::MonotonicTime now) const;

  [[nodiscard]] const Refused& refused() const { return refused_; }

 private:
  struct Bid {
    double salience = 0;
    hc::MonotonicTime made{};
  };

  hc::Status check(std::int32_t mode, double salience);
  void drop_expired(hc::MonotonicTime now);
  [[nodiscard]] std::int32_t winner(hc::MonotonicTime now) const;

  WorkspaceOptions options_;
  std::map<std::int32_t, Bid> bids_;  // by mode
  std::optional<std::pair<std::int32_t, Bid>> person_;
  std::int32_t focus_ = 0, before_ = 0;
  hc::MonotonicTime since_{};  // of the focus
  bool is_stopped_ = false;
  Refused refused_;
};
