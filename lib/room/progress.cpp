// SPDX-License-Identifier: Apache-2.0
#include <room/progress.h>

#include <algorithm>
#include <cmath>

namespace hc::room {

double duration(double distance, double speed, double acceleration) {
  const double peak = std::min(speed, std::sqrt(distance * acceleration));
  return distance / peak + peak / acceleration;
}

Progress travel(double distance, double speed, double acceleration, double t) {
  const double peak = std::min(speed, std::sqrt(distance * acceleration));
  const double total = duration(distance, speed, acceleration), ramp = peak / acceleration;
  if (t <= 0) return {0, 0};
  if (t >= total) return {distance, 0};
  if (t < ramp) return {acceleration * t * t / 2, acceleration * t};
  const double left = total - t;
  if (left < ramp) return {distance - acceleration * left * left / 2, acceleration * left};
  return {peak * (t - ramp / 2), peak};
}

}  // namespace hc::room
