// SPDX-License-Identifier: Apache-2.0
#pragma once
// Draws a graph as text for a terminal, or in Graphviz's DOT language. Pure.

#include <string>
#include <vector>

#include <graph/plan.h>
#include <hc/contract/graph_state.h>

namespace tool {

struct Drawing {
  struct Box {
    std::string name;
    std::string words;  ///< below the name: the program, or the status
    std::string group;  ///< the included graph it is from; empty: none
    bool is_bold = false, is_wrong = false, is_idle = false;
  };
  struct Arrow {
    std::string from, to;  ///< MODULE.PORT, or a URI
    std::string words;
    bool is_bold = false, is_wrong = false;
  };
  std::string title;
  std::vector<Box> boxes;
  std::vector<Arrow> arrows;
  bool is_running = false;
};

/// Draws a planned graph.
Drawing drawing_of(const hc::Plan& plan, const std::string& title);
/// Draws a running graph.
Drawing drawing_of(const hc::GraphState& state);

/// A paragraph for each module: its name, and a line for each outgoing link.
std::string as_text(const Drawing& drawing, bool is_plain);

/// Input for Graphviz's dot: ports inside their modules, frames around included graphs, a legend.
std::string as_dot(const Drawing& drawing);

}  // namespace tool
