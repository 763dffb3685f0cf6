// SPDX-License-Identifier: Apache-2.0
#pragma once
// A head that is steered by a stick. Pure.

#include <optional>

#include <gaze/follower.h>

namespace hc::gaze {

/// Where a stick has steered to: from the head's measured orientation, at the rates that it is
/// pushed with, and never far ahead of the head. Times are in seconds, of any origin.
class Stick {
 public:
  /// How long a push counts unless it is repeated [s].
  static constexpr double kHold = 0.1;

  /// @param rates  [rad/s]; both 0: it is released.
  /// @param measured  where the head looks.
  void push(const Angles& rates, double now, const Angles& measured);
  /// The setpoint and its rates while the stick is pushed; for kHold after its release, where to
  /// stop. Nothing: the stick is in its middle.
  std::optional<Motion> at(double now, const Angles& measured);
  /// When it was out of its middle last [s].
  [[nodiscard]] std::optional<double> last() const { return pushed_; }

 private:
  std::optional<Motion> motion_;
  double time_ = 0;               // of motion_
  double pushed_at_ = 0;          // when motion_'s rates were set
  std::optional<double> pushed_;  // with rates other than 0
};

}  // namespace hc::gaze
