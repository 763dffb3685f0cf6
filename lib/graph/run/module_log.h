// SPDX-License-Identifier: Apache-2.0
#pragma once
// The log of a module: lines from its standard error and from its reports, within limits. Pure: the
// time is a parameter. Internal to graph.

#include <chrono>
#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include <graph/log_limit.h>
#include <graph/run/lines.h>
#include <hc/base/clock.h>
#include <hc/contract/graph_state.h>
#include <hc/contract/log_line.h>

namespace hc::internal {

class ModuleLog {
 public:
  static constexpr int kMostResults = 100;  ///< never dropped; as many as are printed at the end

  using Take = std::function<void(Level level, const std::string& text)>;

  /// @param module  its name, with which it may begin its lines.
  /// @param take  gets each line within the limits.
  ModuleLog(const std::string& module, Take take)
      : prefix_(module + ": "), take_(std::move(take)) {}

  /// Takes a piece of its standard error. Returns whether to read on without a pause.
  bool add(std::string_view piece, MonotonicTime now) {
    lines_.add(piece, [&](const std::string& line) { add(Level::Info, line, now); });
    return !limit_.is_over();
  }

  void add(Level level, std::string text, MonotonicTime now) {
    if (text.starts_with(prefix_)) text.erase(0, prefix_.size());
    const bool is_repeated = level == Level::Result || level == Level::Error;  // at the graph's end
    if (is_repeated) ++results_;
    const bool is_kept = is_repeated && results_ <= kMostResults;
    if (!is_kept && !limit_.passes(text.size(), now)) return;
    if (level != Level::Notice) {
      lines_.keep(text);
      last_level_ = level;
      last_time_ = now;
    }
    take_(level, text);
  }

  /// Its process has ended.
  void finish(MonotonicTime now) {
    lines_.finish([&](const std::string& line) { add(Level::Info, line, now); });
  }
  /// The last lines, oldest first; of this process.
  [[nodiscard]] const std::deque<std::string>& last() const { return lines_.last(); }
  void forget_last() { lines_.forget(); }

  /// A log line about dropped lines, once their second has passed; empty: none.
  std::string take_remark(MonotonicTime now) { return limit_.take_remark(now); }

  /// Adds the last line to the state of the module.
  void describe(ModuleState& state, MonotonicTime now) const {
    if (last().empty()) return;
    state.last_line = last().back();
    state.last_level = last_level_;
    state.last_line_age = std::chrono::duration<double>(now - last_time_).count();
  }

 private:
  std::string prefix_;
  Take take_;
  Lines lines_;
  LogLimit limit_;
  int results_ = 0;  // results and errors so far
  Level last_level_ = Level::Info;
  MonotonicTime last_time_{0};
};

}  // namespace hc::internal
