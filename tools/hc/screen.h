// SPDX-License-Identifier: Apache-2.0
#pragma once
// What `hc top` shows: a graph's state as lines of a terminal. Pure.

#include <cstddef>
#include <string>

#include <nlohmann/json.hpp>

namespace tool {

struct Screen {
  std::size_t width = 80, height = 24;  ///< [character]; height 0: as many lines as there are
  bool is_plain = false;                ///< without bold and colours
};

/// A graph's state, at most as large as the screen, each line with a line feed. What is in the
/// global workspace is bold; what has failed is red, and comes first where not all fits.
std::string draw(const nlohmann::json& state, const Screen& screen);

/// "1.2 k": a number in at most five characters with a unit's prefix.
std::string short_number(double number);

}  // namespace tool
