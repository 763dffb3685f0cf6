// SPDX-License-Identifier: Apache-2.0
#pragma once
// Decides which mode has the focus: tasks bid with a salience, and one wins. Pure: times come from
// the caller and never go back.
//
// The rules, applied only by decide():
// - A bid belongs to a mode and a source. It is valid until it expires or the source bids for the
//   mode again; salience 0 withdraws this bid only. A mode's bid is the greatest of its sources.
// - While the mode in focus has a bid, a challenger takes the focus if its salience is greater by
//   more than the margin, and the focus has not changed for the dwell time.
// - When the bid in focus ends, the focus goes at once, even within the dwell time, to the greatest
//   bid; among equal ones to the lowest mode; without any to 0 (none).
// - Persons' bids override all others, regardless of dwell time and margin. The greatest wins. Of
//   equal ones the mode in focus keeps it, else the bid that began last wins. Repeating a bid does
//   not restart it, so contradicting persons do not alternate.
// - While the brake holds, no mode has the focus. Bids are still taken.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <hc/base/clock.h>
#include <hc/base/result.h>

#include "brake.h"

struct WorkspaceOptions {
  double margin = 0.1;  ///< of salience
  std::chrono::nanoseconds dwell{1'000'000'000};
  std::chrono::nanoseconds expiry{1'000'000'000};
  std::chrono::nanoseconds person_expiry{60'000'000'000};  ///< of a person's bid
};

/// The state of a mode.
struct Standing {
  std::int32_t mode = 0;
  double salience = 0;             ///< a person's bid if there is one
  std::chrono::nanoseconds age{};  ///< since the bid was made
  bool in_focus = false;
  bool is_of_person = false;
};

/// Bids that were refused, by reason.
struct Refused {
  std::int64_t salience = 0;  ///< NaN or not in 0 … 1
  std::int64_t mode = 0;      ///< <= 0, or not in the graph
  std::int64_t time = 0;      ///< expired or from the future
  std::int64_t crowded = 0;   ///< more than kMostModes, or than kMostSources for the mode

  [[nodiscard]] std::int64_t total() const { return salience + mode + time + crowded; }
};

/// The mode and source of a bid.
struct Bidder {
  std::int32_t mode = 0, source = 0;
};

class Workspace {
 public:
  /// Maximum number of modes with bids, and of sources for each.
  static constexpr std::size_t kMostModes = 1024, kMostSources = 32;
  /// How far a bidder's clock may be ahead.
  static constexpr std::chrono::milliseconds kAhead{200};

  explicit Workspace(const WorkspaceOptions& options = {}) : options_(options) {}

  void set_options(const WorkspaceOptions& options) { options_ = options; }
  /// Sets the graph's modes and their names. If empty, any mode may have bids.
  void set_modes(std::map<std::int32_t, std::string> names) { names_ = std::move(names); }

  /// Takes a task's bid. @param salience  0 … 1; 0 withdraws. @param made  its expiry counts from
  /// then. Errors: Malformed, TooLarge; the bid is counted as refused and ignored.
  hc::Status bid(const Bidder& who, double salience, hc::MonotonicTime made,
                 hc::MonotonicTime now) {
    return take(who, salience, made, now, tasks_, options_.expiry);
  }
  /// Takes a person's bid.
  hc::Status bid_of_person(const Bidder& who, double salience, hc::MonotonicTime made,
                           hc::MonotonicTime now) {
    return take(who, salience, made, now, persons_, options_.person_expiry);
  }

  /// Applies the rules; true if the focus changed. Call each period.
  bool decide(hc::MonotonicTime now);

  /// The last change of focus and the bids behind it: "track (0.60) over read (0.40), margin 0.10",
  /// "none; stopped by web.stop".
  [[nodiscard]] std::string last_change() const;

  /// The mode in focus since the last decide(); 0: none.
  [[nodiscard]] std::int32_t focus() const { return focus_; }

  /// The modes with a bid at the last decide() or since, in ascending order.
  [[nodiscard]] std::vector<Standing> standings(hc::MonotonicTime now) const;

  [[nodiscard]] const Refused& refused() const { return refused_; }

  Brake brake;

 private:
  struct Bid {
    double salience = 0;
    hc::MonotonicTime made{}, began{};
  };
  using BidsOfMode = std::map<std::int32_t, Bid>;  // by source; none is empty
  using Bids = std::map<std::int32_t, BidsOfMode>;

  hc::Status take(const Bidder& who, double salience, hc::MonotonicTime made, hc::MonotonicTime now,
                  Bids& bids, std::chrono::nanoseconds expiry);
  hc::Status check(const Bidder& who, double salience);
  static const Bid& greatest(const BidsOfMode& bids);
  static void drop_expired(Bids& bids, hc::MonotonicTime now, std::chrono::nanoseconds expiry);
  [[nodiscard]] std::int32_t wanted_by_persons() const;
  [[nodiscard]] std::int32_t wanted_by_tasks(hc::MonotonicTime now) const;

  WorkspaceOptions options_;
  std::map<std::int32_t, std::string> names_;
  Bids tasks_, persons_;
  std::int32_t focus_ = 0, before_ = 0;
  std::string held_back_;      // why the brake holds, else empty
  hc::MonotonicTime since_{};  // last change of focus
  Refused refused_;
};
