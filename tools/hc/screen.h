// SPDX-License-Identifier: Apache-2.0
#pragma once
// What `hc top` and `hc run` show: a graph's state as lines of a terminal. Pure.

#include <cstddef>
#include <string>
#include <vector>

#include <hc/contract/graph_state.h>

namespace tool {

struct Screen {
  std::size_t width = 80, height = 24;  ///< [character]; height 0: as many lines as there are
  bool is_plain = false;                ///< without bold and colours
  std::size_t first = 0;                ///< lines of the tables that are scrolled away
};

/// A bid for the focus, as the workspace's output `standings` has it.
struct Bid {
  std::string workspace;  ///< that it was sent to; empty: the only one
  std::string mode;
  double salience = 0, age = 0;  ///< age [s]
  bool in_focus = false, is_person = false;
};

/// A graph's state, at most as large as the screen, each line with a line feed. What is in the
/// global workspace is bold; what is in trouble is red, and comes first.
std::string draw(const hc::GraphState& state, const std::vector<Bid>& bids, const Screen& screen);

/// "5 running, 1 given up | 1230 messages/s | focus: track"
std::string status_line(const hc::GraphState& state);

/// Whether a module is in trouble, by its status or by the last line of its log: devices and peers
/// that a module waits for do not end it.
bool is_in_trouble(const hc::ModuleState& module);

/// "running", "stalled: busy", "idle (not in focus)".
std::string status_text(const hc::ModuleState& module);

/// "1.2k", "0.24": a number in at most five characters.
std::string short_number(double number);

/// "2.10ms", "0.24s"
std::string short_time(double seconds);

}  // namespace tool
