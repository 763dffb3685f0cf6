// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the processes of a module have reported (contract/report.h): counters added up over its
// processes and links, parameters, state. Pure. Internal to graph.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <graph/plan.h>
#include <hc/base/clock.h>
#include <hc/contract/report.h>

namespace hc::internal {

/// What is known of one end of a link, over all processes that the module has been.
struct EndReport : LinkCounters {
  /// Messages between the last two reports with any; falls when none come, and is 0 after 5 s.
  double per_second = 0;
  double bytes_per_second = 0;
};

class Reports {
 public:
  /// Bounds on what is kept, whatever a module reports.
  static constexpr std::size_t kMostEnds = 4096, kMostParameters = 1024;

  /// @param ends  in whose order counters come, inputs first, from a module that does not report
  /// its links.
  explicit Reports(const std::vector<PlannedEnd>& ends) { set_ends(ends); }
  /// Says which ends there are from now on. Reports of others are ignored.
  void set_ends(const std::vector<PlannedEnd>& ends);

  /// Takes a report. Whether anything but numbers has changed.
  bool take(const Message& message, MonotonicTime now);

  /// Says that the process has ended: the next one counts from 0.
  void end();

  /// Of an end; null where nothing has been reported of it.
  [[nodiscard]] const EndReport* find(const PlannedEnd& end) const;
  /// The peers that are connected to an end, of the plan or not, as last reported; -1: unknown.
  [[nodiscard]] std::int64_t peers_of(const PlannedEnd& end) const;
  [[nodiscard]] const std::map<std::string, std::string>& parameters() const { return parameters_; }
  [[nodiscard]] const StateReport& state() const { return state_; }
  /// Whether a link, or one that has its sending end in common with it, is that for whose reader
  /// the module waits.
  [[nodiscard]] bool is_blocked_on(const PlannedLink& link) const;
  /// The output for whose reader the module waits, where it says which.
  [[nodiscard]] std::string blocked_output() const;

 private:
  struct Counted {
    EndReport report;
    LinkCounters past, now;    // of processes that have ended and links that were replaced; of this
    MonotonicTime arrived{0};  // when messages came last, as far as a rate was measured
    Traffic measured;          // at that time
    bool has_row = false;

    void end();
  };

  void take_counters(const std::vector<LinkCounters>& rows, MonotonicTime now);
  static void count(Counted& counted, const LinkCounters& row, bool is_input, MonotonicTime now);
  bool take_links(const Message& message);
  bool take_state(const StateReport& state);
  [[nodiscard]] std::string blocked_key() const;

  std::vector<std::string> order_;             // keys of ends, as the rows of counters come
  bool has_links_ = false;                     // the module has reported them
  std::map<std::string, Counted> ends_;        // of the plan, by key
  std::map<std::string, std::int64_t> peers_;  // of ends, of the plan or not, by key
  std::map<std::string, std::string> parameters_;
  StateReport state_;
};

}  // namespace hc::internal
