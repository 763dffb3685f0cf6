// SPDX-License-Identifier: Apache-2.0
#pragma once
// Which mode has the focus: tasks bid with a salience each, one wins. Pure: time is handed in and
// never goes back.
//
// The rules, judged by decide() and at no other time:
// - A bid is of a mode and a source. It is valid until it expires or the same source bids for the
//   mode again; one of salience 0 withdraws it, and no other. A mode's bid is the greatest of its
//   sources.
// - While the mode in focus has a bid, a challenger takes focus with a salience that is greater by
//   more than the margin, when the focus has been where it is for the dwell time.
// - A focus whose bid has ended goes at once, within its dwell time too, to the greatest bid, of
//   equal ones to that of the lowest mode; when there is none, to 0: none.
// - Persons' bids are above all others, whatever the dwell time and margin say. Of several the
//   greatest wins; of equal ones the mode that has the focus keeps it, else the one whose bid began
//   last wins. To repeat a bid does not begin it anew, so persons who contradict each other do not
//   take turns.
// - While the brake holds no mode has the focus. Bids are taken meanwhile.

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
  double salience = 0;             ///< the person's where the bid is a person's
  std::chrono::nanoseconds age{};  ///< since the bid was made
  bool in_focus = false;
  bool is_of_person = false;
};

/// Bids that were refused, by reason.
struct Refused {
  std::int64_t salience = 0;  ///< not a number, or not from 0 to 1
  std::int64_t mode = 0;      ///< 0 or below, or not of the graph
  std::int64_t time = 0;      ///< expired already, or of the future
  std::int64_t crowded = 0;   ///< kMostModes have bids already, or kMostSources bid for the mode

  [[nodiscard]] std::int64_t total() const { return salience + mode + time + crowded; }
};

/// Who bids, and for what.
struct Bidder {
  std::int32_t mode = 0, source = 0;
};

class Workspace {
 public:
  /// Modes that may have bids at the same time, and sources that may bid for one of them.
  static constexpr std::size_t kMostModes = 1024, kMostSources = 32;
  /// By how much the clock of who bids may be ahead of ours.
  static constexpr std::chrono::milliseconds kAhead{200};

  explicit Workspace(const WorkspaceOptions& options = {}) : options_(options) {}

  void set_options(const WorkspaceOptions& options) { options_ = options; }
  /// The modes that there are, with their names. None: any mode may have bids.
  void set_modes(std::map<std::int32_t, std::string> names) { names_ = std::move(names); }

  /// A task's bid. @param salience  0 … 1; 0 withdraws. @param made  its age counts from there.
  ///
  /// Errors: Malformed, TooLarge; the bid is counted as refused and changes nothing.
  hc::Status bid(const Bidder& who, double salience, hc::MonotonicTime made,
                 hc::MonotonicTime now) {
    return take(who, salience, made, now, tasks_, options_.expiry);
  }
  /// A person's bid, in the same way.
  hc::Status bid_of_person(const Bidder& who, double salience, hc::MonotonicTime made,
                           hc::MonotonicTime now) {
    return take(who, salience, made, now, persons_, options_.person_expiry);
  }

  /// Applies the rules; true when the focus has changed. To be called each period.
  bool decide(hc::MonotonicTime now);

  /// The last change of focus and the bids behind it: "track (0.60) over read (0.40), margin 0.10",
  /// "none; stopped by web.stop".
  [[nodiscard]] std::string last_change() const;

  /// The mode in focus as decide() left it; 0: none.
  [[nodiscard]] std::int32_t focus() const { return focus_; }

  /// Modes that had a bid when decide() was called, and those that came since, by their numbers.
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
  std::string held_back_;      // why no mode has the focus though there are bids
  hc::MonotonicTime since_{};  // of the focus
  Refused refused_;
};
