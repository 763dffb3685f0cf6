// SPDX-License-Identifier: Apache-2.0
#pragma once
// The reports of a module (contract/report.h): counters summed over its processes and links,
// parameters, state. Pure. Internal to graph.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <graph/plan.h>
#include <hc/base/clock.h>
#include <hc/contract/report.h>

namespace hc::internal {

/// The counters of one end of a link, over all processes of the module.
struct EndReport : LinkCounters {
  /// Rate between the last two reports with new messages; decays without any, to 0 after 5 s.
  double per_second = 0;
  double bytes_per_second = 0;
};

class Reports {
 public:
  /// Limits of what is kept from a module's reports.
  static constexpr std::size_t kMostEnds = 4096, kMostParameters = 1024;

  /// @param ends  the order of counters, inputs first, if a module does not report its links.
  explicit Reports(const std::vector<PlannedEnd>& ends) { set_ends(ends); }
  /// Replaces the ends. Reports of other ends are ignored.
  void set_ends(const std::vector<PlannedEnd>& ends);

  /// Takes a report. Returns whether anything except counters has changed.
  bool take(const Message& message, MonotonicTime now);

  /// Notes that the process has ended: the next one counts from 0.
  void end();

  /// The counters of an end; null before its first report.
  [[nodiscard]] const EndReport* find(const PlannedEnd& end) const;
  /// Whether the module has opened an end, as far as it reports its links.
  [[nodiscard]] bool is_open(const PlannedEnd& end) const;
  /// The number of peers connected to an end, planned or not, as last reported; -1: unknown.
  [[nodiscard]] std::int64_t peers_of(const PlannedEnd& end) const;
  [[nodiscard]] const std::map<std::string, std::string>& parameters() const { return parameters_; }
  [[nodiscard]] const StateReport& state() const { return state_; }
  /// Whether the module waits for a reader of this link, or of one with the same sending end.
  [[nodiscard]] bool is_blocked_on(const PlannedLink& link) const;
  /// The output whose reader the module waits for; empty: none or unknown.
  [[nodiscard]] std::string blocked_output() const;

 private:
  struct Counted {
    EndReport report;
    LinkCounters past;         // of ended processes and replaced links
    LinkCounters now;          // of this process
    MonotonicTime arrived{0};  // time of the last rate measurement with new messages
    Traffic measured;          // at that time
    bool has_row = false;

    void end();
  };

  void take_counters(const std::vector<LinkCounters>& rows, MonotonicTime now);
  static void count(Counted& counted, const LinkCounters& row, bool is_input, MonotonicTime now);
  bool take_links(const Message& message);
  bool take_state(const StateReport& state);
  [[nodiscard]] std::string blocked_key() const;

  std::vector<std::string> order_;             // keys of ends in the order of the counters
  bool has_links_ = false;                     // the module has reported its links
  std::map<std::string, Counted> ends_;        // of the plan, by key
  std::map<std::string, std::int64_t> peers_;  // of all ends, by key
  std::map<std::string, std::string> parameters_;
  StateReport state_;
};

}  // namespace hc::internal
