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

bool StickTeller::is_due(MonotonicTime now, const Stick& stick, MonotonicTime period) {
  if (stick == told_ && (stick.is_in_middle() || now - told_at_ < period)) return false;
  told_ = stick;
  told_at_ = now;
  return true;
}

std::optional<MonotonicTime> StickTeller::rest(MonotonicTime now, MonotonicTime period) const {
  if (told_.is_in_middle()) return std::nullopt;
  return std::max(told_at_ + period - now, MonotonicTime(0));
}

}  // namespace hc
