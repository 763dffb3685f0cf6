// SPDX-License-Identifier: Apache-2.0
#pragma once
// Draws a graph's state for a terminal, for `hc top` and `hc run`. Pure.

#include <cstddef>
#include <string>
#include <vector>

#include <hc/contract/graph_state.h>

namespace tool {

struct Screen {
  std::size_t width = 80, height = 24;  ///< [character]; height 0: unlimited
  bool is_plain = false;                ///< without bold and colours
  std::size_t first = 0;                ///< lines of the tables scrolled past
};

/// A bid for the focus, from the workspace's output `standings`.
struct Bid {
  std::string workspace;  ///< empty: the only one
  std::string mode;
  double salience = 0;
  bool in_focus = false, is_person = false;
};

/// Draws a graph's state within the screen, each line with a line feed. The global workspace is
/// bold; modules and links in trouble are red and come first.
std::string draw(const hc::GraphState& state, const std::vector<Bid>& bids, const Screen& screen);

/// Such as "5 running, 1 given up | 1230 messages/s | focus: track".
std::string status_line(const hc::GraphState& state);

/// Whether a module is in trouble, by its status or the last line of its log: a running module may
/// be waiting for a device or a peer.
bool is_in_trouble(const hc::ModuleState& module);

/// Such as "running", "stalled: busy" or "idle (not in focus)".
std::string status_text(const hc::ModuleState& module);

/// A number in at most five characters, such as "1.2k" or "0.24".
std::string short_number(double number);

/// "2.10ms", "0.24s"
std::string short_time(double seconds);

}  // namespace tool
