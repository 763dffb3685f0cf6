// SPDX-License-Identifier: Apache-2.0
#pragma once
// A graph as text for a terminal, and as a drawing in Graphviz's language. Pure.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <hc/graph/plan.h>

namespace tool {

struct Drawing {
  struct Box {
    std::string name;
    std::string words;  ///< below the name: what the program is, or how it does
    bool is_bold = false, is_wrong = false, is_idle = false;
  };
  struct Arrow {
    std::string from, to;  ///< MODULE.PORT, or a URI of the world outside
    std::string words;
    bool is_bold = false;
  };
  std::string title;
  std::vector<Box> boxes;
  std::vector<Arrow> arrows;
};

/// Of a graph that is to run, and of one that runs, from what it says of itself.
Drawing drawing_of(const hc::Plan& plan, const std::string& title);
Drawing drawing_of(const nlohmann::json& state);

/// A paragraph for each module: its name, and a line for each link that leaves it. Bold where
/// `is_plain` does not forbid it.
std::string as_text(const Drawing& drawing, bool is_plain);

/// For Graphviz's dot, which makes an SVG of it. The names of ports stand at the ends of arrows.
std::string as_dot(const Drawing& drawing);

}  // namespace tool
