// SPDX-License-Identifier: Apache-2.0
#include <drivers/joystick/stick.h>

#include <algorithm>
#include <cmath>

namespace hc {
namespace {

double beyond(double value, double dead_zone) {
  const double distance = std::abs(value) - dead_zone;
  if (!(distance > 0)) return 0;
  return std::copysign(std::min(distance / (1 - dead_zone), 1.0), value);
}

}  // namespace

Stick stick_of(std::span<const double> axes, double dead_zone) {
  if (axes.size() < 2) return {};
  // Subtracted, so that the middle is no negative zero.
  return {0.0 - beyond(axes[0], dead_zone), beyond(axes[1], dead_zone)};
}

}  // namespace hc
