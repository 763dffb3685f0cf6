// SPDX-License-Identifier: Apache-2.0
#include "nod.h"

#include <algorithm>
#include <cmath>

namespace {

constexpr double kRise = 2;       // from rest to the full pace [s]
constexpr double kPitch = 0.25;   // of the amplitude of yaw
constexpr double kFaster = 1.25;  // pitch than yaw, so that they do not repeat together soon

}  // namespace

HeadAngles angles_at(const Nod& nod, double time) {
  // The pace of the phase rises evenly from 0, then stays.
  const double rising = std::clamp(time, 0.0, kRise);
  const double paced = rising * rising / (2 * kRise) + std::max(0.0, time - kRise);
  const double phase = nod.speed / nod.amplitude * paced;
  return {kPitch * nod.amplitude * std::sin(kFaster * phase), nod.amplitude * std::sin(phase)};
}
