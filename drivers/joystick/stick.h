// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a stick says: a wish to turn; and when it is told. Pure.

#include <optional>
#include <span>

#include <hc/base/clock.h>

namespace hc {

/// A wish to turn, each −1 … 1; both 0 in the middle.
struct Stick {
  double left = 0;  ///< > 0 to the left, < 0 to the right
  double down = 0;  ///< > 0 down, < 0 up
  bool operator==(const Stick&) const = default;
  [[nodiscard]] bool is_in_middle() const { return *this == Stick{}; }
};

/// The stick of a controller's first two axes, each −1 … 1, right and down > 0.
/// @param dead_zone  what is nearer to the middle of an axis counts as 0, and what is beyond it is
/// rescaled, so that there is no jump and the end is still 1. [0 … 1)
Stick stick_of(std::span<const double> axes, double dead_zone);

/// Says when a stick is to be told: at once when it has changed, again and again while it is out of
/// its middle, and once in the middle.
class StickTeller {
 public:
  /// Whether it is to be told now.
  bool is_due(MonotonicTime now, const Stick& stick, MonotonicTime period);
  /// How long nothing is due unless the stick changes; nothing: for ever.
  [[nodiscard]] std::optional<MonotonicTime> rest(MonotonicTime now, MonotonicTime period) const;

 private:
  Stick told_;
  MonotonicTime told_at_{0};
};

}  // namespace hc
