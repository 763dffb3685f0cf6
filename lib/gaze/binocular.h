// SPDX-License-Identifier: Apache-2.0
#pragma once
// Triangulates a target that the eyes see one after the other. Pure.

#include <optional>

#include <gaze/eyes.h>
#include <hc/base/time.h>

namespace hc::gaze {

/// Combines two eyes' sightings of one target. Times are of any one clock.
class Binocular {
 public:
  /// Takes a sighting of the target by one eye.
  ///
  /// Waits for the other eye's sighting, which may be later than the next one of this eye, for up
  /// to three images of this eye; then assumes the last distance.
  /// @param distance  assumed if both eyes have never seen a target [m].
  /// @returns  the target's position in the head's frame [m]. Nothing while waiting for the other
  ///     eye, or if both see different things.
  std::optional<Eigen::Vector3d> see(const Eyes& eyes, Side side, Time time,
                                     const Eigen::Vector2d& pixel, double distance);

 private:
  struct Sighting {
    Time time;
    Eigen::Vector2d pixel;  // [px]
  };
  std::optional<Sighting> left_, right_;  // last
  double range_ = 0;                      // distance of the last target seen by both eyes [m]
};

}  // namespace hc::gaze
