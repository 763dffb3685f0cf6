// SPDX-License-Identifier: Apache-2.0
#pragma once
// Steers a head with a stick. Pure.

#include <optional>

#include <gaze/follower.h>

namespace hc::gaze {

/// The setpoint of a stick: starts at the head's measured orientation, moves at the stick's rates,
/// and never leads the head by much. Times are in seconds of any one clock.
class Stick {
 public:
  /// How long a push is valid unless repeated [s].
  static constexpr double kHold = 0.1;

  /// @param rates  [rad/s]; both 0: it is released.
  /// @param measured  orientation of the head.
  void push(const Angles& rates, double now, const Angles& measured);
  /// The setpoint and its rates while the stick is pushed; for kHold after its release, the
  /// position at which to stop; then nothing.
  std::optional<Motion> at(double now, const Angles& measured);
  /// When the stick was last pushed [s].
  [[nodiscard]] std::optional<double> last() const { return pushed_; }

 private:
  std::optional<Motion> motion_;
  double time_ = 0;               // of motion_ [s]
  double pushed_at_ = 0;          // when motion_'s rates were set
  std::optional<double> pushed_;  // last push with a rate other than 0
};

}  // namespace hc::gaze
