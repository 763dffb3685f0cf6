// SPDX-License-Identifier: Apache-2.0
#include "nod.h"

#include <algorithm>
#include <cmath>

namespace {

constexpr double kRise = 2;       // from rest to full speed [s]
constexpr double kPitch = 0.25;   // amplitude relative to yaw
constexpr double kFaster = 1.25;  // frequency of pitch relative to yaw, so that the motion varies

}  // namespace

HeadAngles angles_at(const Nod& nod, double time) {
  // The rate of the phase rises linearly from 0, then is constant.
  const double rising = std::clamp(time, 0.0, kRise);
  const double paced = rising * rising / (2 * kRise) + std::max(0.0, time - kRise);
  const double phase = nod.speed / nod.amplitude * paced;
  return {kPitch * nod.amplitude * std::sin(kFaster * phase), nod.amplitude * std::sin(phase)};
}
