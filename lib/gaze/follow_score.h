// SPDX-License-Identifier: Apache-2.0
#pragma once
// How well one gaze follows another, and by how much it is behind. Pure.

#include <array>
#include <string>
#include <vector>

#include <gaze/aim.h>

namespace hc::gaze {

/// A gaze at a time.
struct TimedAngles {
  double time = 0;  ///< [s], of any origin
  Angles angles;
};

struct FollowScore {
  double rms = 0, max = 0;  ///< angle between the two at equal times [rad]
  /// The delay of the follower that fits best; < 0: it is ahead [s].
  double behind = 0;
  std::size_t samples = 0;  ///< of those, all in the order of time

  /// rms, max, behind, samples.
  [[nodiscard]] std::array<double, 4> numbers() const;
  /// "error 0.27° RMS, 0.63° at most, behind by 5 ms".
  [[nodiscard]] std::string text() const;
};

/// What a gaze is between its samples: a straight line in each angle; before and after them the
/// nearest.
/// @param samples  at least one, in the order of time.
Angles angles_at(const std::vector<TimedAngles>& samples, double time);

/// Compares at the times of `follows` from `begin` to `end` [s].
///
/// @param wanted, follows  in the order of time.
/// Samples of `follows` outside the time of `wanted` are ignored.
FollowScore score_follow(const std::vector<TimedAngles>& wanted,
                         const std::vector<TimedAngles>& follows, double begin, double end);

}  // namespace hc::gaze
