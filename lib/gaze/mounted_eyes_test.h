// SPDX-License-Identifier: Apache-2.0
#pragma once
// Eyes for tests: 0.10 m apart, looking straight ahead.

#include <gaze/eyes.h>

namespace hc::gaze {

inline Eigen::Isometry3d looking_ahead_from(const Eigen::Vector3d& place) {
  return Eigen::Translation3d(place) * Eigen::Isometry3d(optical());
}

inline Eyes mounted_eyes() {
  return {looking_ahead_from({0.06, 0.05, 0.05}), looking_ahead_from({0.06, -0.05, 0.05})};
}

}  // namespace hc::gaze
