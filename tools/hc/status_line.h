// SPDX-License-Identifier: Apache-2.0
#pragma once
// The last line of a terminal, where a graph that runs tells what it does.

#include <string>
#include <string_view>

#include <hc/graph/state.h>

namespace tool {

/// What a graph does, in one line: "5 running, 1 given up | 1230 messages/s | focus: track".
std::string summary_of(const hc::GraphState& state);

/// Lines on standard error, and where that is a terminal, one below them that changes.
class StatusLine {
 public:
  /// @param wanted  false: there is none.
  explicit StatusLine(bool wanted);
  ~StatusLine() { erase(); }
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  void say(std::string_view line);
  void show(const hc::GraphState& state);
  void erase();

 private:
  void draw();

  bool on_terminal_;
  std::string shown_;  // empty: nothing is
};

}  // namespace tool
