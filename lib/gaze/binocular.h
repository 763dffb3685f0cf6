// SPDX-License-Identifier: Apache-2.0
#pragma once
// The place of a target, from what each eye sees of it in turn. Pure.

#include <cstdint>
#include <optional>

#include <gaze/eyes.h>

namespace hc::gaze {

/// Puts together what two eyes see of one target. Times are in nanoseconds, of any origin.
class Binocular {
 public:
  /// Takes in where an eye saw the target.
  ///
  /// The other eye's word is awaited, which may come later than this one's next; it is missed when
  /// it has not come for three of this eye's images.
  /// @param distance  of the target then, if both have never seen it [m].
  /// @returns  the target's place in the head [m]. Nothing: the other eye's word is awaited, or
  ///     both see what is not the same.
  std::optional<Eigen::Vector3d> see(const Eyes& eyes, Side side, std::int64_t time,
                                     const Eigen::Vector2d& pixel, double distance);

 private:
  struct Sighting {
    std::int64_t time;
    Eigen::Vector2d pixel;  // [px]
  };
  std::optional<Sighting> left_, right_;  // the last of each
  double range_ = 0;                      // of the last target that both eyes saw [m]
};

}  // namespace hc::gaze
