// SPDX-License-Identifier: Apache-2.0
#pragma once
// The last line of a terminal, which shows the status of the running graph.

#include <string>
#include <string_view>

#include <hc/contract/graph_state.h>

#include "outbox.h"

namespace tool {

/// The status of a graph in one line: "5 running, 1 given up | 1230 messages/s | focus: track".
std::string summary_of(const hc::GraphState& state);

/// Log lines on standard error, and on a terminal a status line below them. Only finish() waits for
/// the reader.
class StatusLine {
 public:
  /// @param wanted  false: no status line.
  explicit StatusLine(bool wanted);

  void say(std::string_view line) { outbox_.say(line); }
  void show(const hc::GraphState& state);
  /// Waits until the lines are written, as long as the reader makes progress.
  void finish() { outbox_.finish(); }

 private:
  bool on_terminal_;
  Outbox outbox_;
};

}  // namespace tool
