// SPDX-License-Identifier: Apache-2.0
#pragma once
// The last line of a terminal, where a graph that runs tells what it does.

#include <string>
#include <string_view>

#include <hc/graph/state.h>

#include "outbox.h"

namespace tool {

/// What a graph does, in one line: "5 running, 1 given up | 1230 messages/s | focus: track".
std::string summary_of(const hc::GraphState& state);

/// Lines on standard error, and where that is a terminal, one below them that changes. Nothing but
/// finish() waits for who reads them.
class StatusLine {
 public:
  /// @param wanted  false: there is none.
  explicit StatusLine(bool wanted);

  void say(std::string_view line) { outbox_.say(line); }
  void show(const hc::GraphState& state);
  /// Waits until the lines are written, as long as somebody reads, and takes the last one away.
  void finish() { outbox_.finish(); }

 private:
  bool on_terminal_;
  Outbox outbox_;
};

}  // namespace tool
