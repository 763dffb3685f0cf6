// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a module tells of itself over its management link: counters, links, parameters and its
// system mode, told apart by src. Pure. Internal to graph.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/clock.h>
#include <hc/graph/plan.h>
#include <hc/link/link.h>
#include <hc/mtp/message.h>

namespace hc::internal {

/// What is known of one end of a link.
struct EndReport {
  Traffic traffic;             ///< over all processes that the module has been
  std::uint64_t left_out = 0;  ///< messages taken and not handled: out of focus or idle
  double per_second = 0;       ///< messages, between the last two reports
  double bytes_per_second = 0;
  /// Of messages that came since the report before: p50, p99, greatest; -1: none came. [ns]
  std::array<std::int64_t, 3> age{-1, -1, -1}, gap{-1, -1, -1};
};

class Reports {
 public:
  /// Tells reports apart, by src.
  enum Sender : std::int32_t { kCounters = 1, kLinks, kParameters, kState, kRefusal };

  /// What is kept of those that a module tells, whatever it tells.
  static constexpr std::size_t kMostEnds = 4096, kMostParameters = 1024;

  /// @param ends  in whose order counters come, inputs first, from one that does not tell.
  explicit Reports(const std::vector<PlannedEnd>& ends) { set_ends(ends); }
  /// Says which ends there are from now on. What is told of others is not counted.
  void set_ends(const std::vector<PlannedEnd>& ends);

  /// Takes a report. Whether it tells of a change, other than in numbers.
  bool take(const Message& message, MonotonicTime now);

  /// Says that the process has ended: the next one counts from 0.
  void end();

  /// Of an end; null where nothing has been told of it.
  [[nodiscard]] const EndReport* find(const PlannedEnd& end) const;
  [[nodiscard]] const std::map<std::string, std::string>& parameters() const { return parameters_; }

  std::int64_t mode = 0;
  std::int64_t focus = 0;  ///< last heard; 0: none
  bool in_focus = true;
  bool awaits_reader = false;  ///< one of its outputs does, and so the module

 private:
  struct Counted {
    EndReport report;
    Traffic past;  // of processes that have ended, and of links that were made anew
    std::uint64_t past_left_out = 0;
    Traffic now;
    std::uint64_t left_out_now = 0;
    bool is_told = false;  // a row has come

    void end();
  };

  void take_counters(const MatrixView<const std::int64_t>& rows, MonotonicTime now);
  static void count(Counted& counted, const EndReport& row, double seconds);
  bool take_links(const Message& message);
  bool take_parameters(const Message& message);
  bool take_state(const MatrixView<const std::int64_t>& rows);

  std::vector<std::string> order_;  // keys of ends, as the rows of counters come
  bool has_told_links_ = false;
  std::map<std::string, Counted> ends_;  // of the plan, by key
  std::map<std::string, std::string> parameters_;
  MonotonicTime counted_{0};  // when counters came last; 0: this process has told none
};

}  // namespace hc::internal
