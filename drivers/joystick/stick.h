// SPDX-License-Identifier: Apache-2.0
#pragma once
// A stick as a command to turn. Pure.

#include <algorithm>
#include <cmath>
#include <span>

namespace hc {

/// A turn, each −1 … 1; both 0 in the middle.
struct Stick {
  double left = 0;  ///< > 0 to the left, < 0 to the right
  double down = 0;  ///< > 0 down, < 0 up
  bool operator==(const Stick&) const = default;
  [[nodiscard]] bool is_in_middle() const { return *this == Stick{}; }
};

/// The stick of a controller's first two axes, each −1 … 1, right and down > 0.
/// @param dead_zone  smaller deflections of an axis are 0, larger ones are rescaled to start at 0
/// and end at 1 [0 … 1).
inline Stick stick_of(std::span<const double> axes, double dead_zone) {
  const auto beyond = [&](double value) {
    const double distance = std::abs(value) - dead_zone;
    if (!(distance > 0)) return 0.0;
    return std::copysign(std::min(distance / (1 - dead_zone), 1.0), value);
  };
  if (axes.size() < 2) return {};
  // Subtracted, to avoid a negative zero.
  return {0.0 - beyond(axes[0]), beyond(axes[1])};
}

}  // namespace hc
