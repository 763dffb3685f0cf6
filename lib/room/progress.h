// SPDX-License-Identifier: Apache-2.0
#pragma once
// Motion from rest to rest with a limited acceleration. Pure.

namespace hc::room {

/// Position and speed on the way.
struct Progress {
  double way, speed;
};

/// What distance, peak speed and acceleration mean is up to the caller, in [m] or [rad], and [s].
double duration(double distance, double speed, double acceleration);
/// @param t  since the begin [s]; before it and after the end, it rests.
Progress travel(double distance, double speed, double acceleration, double t);

/// A smooth step: 0 at 0 and before, 1 at 1 and after, with no speed at both ends.
inline double ease(double x) {
  if (x <= 0) return 0;
  return x >= 1 ? 1 : x * x * (3 - 2 * x);
}

}  // namespace hc::room
