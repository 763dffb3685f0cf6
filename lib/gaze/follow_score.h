// SPDX-License-Identifier: Apache-2.0
#pragma once
// Scores how well one gaze follows another, and its delay. Pure.

#include <array>
#include <string>
#include <vector>

#include <gaze/aim.h>

namespace hc::gaze {

/// A gaze at a time.
struct TimedAngles {
  double time = 0;  ///< of any one clock [s]
  Angles angles;
};

struct FollowScore {
  double rms = 0, max = 0;  ///< angle between the two at equal times [rad]
  /// Best-fitting delay of the follower; < 0: ahead [s].
  double behind = 0;
  std::size_t samples = 0;

  /// rms, max, behind, samples.
  [[nodiscard]] std::array<double, 4> numbers() const;
  /// "error 0.27° RMS, 0.63° at most, behind by 5 ms".
  [[nodiscard]] std::string text() const;
};

/// The gaze at a time: linear interpolation between samples; outside the nearest.
/// @param samples  at least one, in the order of time.
Angles angles_at(const std::vector<TimedAngles>& samples, double time);

/// Compares gazes at the times of `follows` from `begin` to `end` [s].
///
/// @param wanted, follows  in the order of time; samples of `follows` outside `wanted` are ignored.
FollowScore score_follow(const std::vector<TimedAngles>& wanted,
                         const std::vector<TimedAngles>& follows, double begin, double end);

}  // namespace hc::gaze
