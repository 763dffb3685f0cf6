// SPDX-License-Identifier: Apache-2.0
#pragma once
// A head that is steered by a stick. Pure.

#include <optional>

#include <gaze/follower.h>

namespace hc::gaze {

/// Where a stick has steered to: on from how the head stands at the rates that it is pushed with,
/// and never far ahead of the head. Times are in seconds, of any origin.
class Stick {
 public:
  /// A push counts for so long if it is not told again [s].
  static constexpr double kTold = 0.1;

  /// @param rates  [rad/s]; both 0: it is let go.
  /// @param stands  how the head stands.
  void push(const Angles& rates, double now, const Angles& stands);
  /// Where the head is to be and how fast, while the stick is pushed; after it was let go, for
  /// kTold where it is to stop. Nothing: the stick wants nothing.
  std::optional<Motion> at(double now, const Angles& stands);
  /// When it was out of its middle last [s].
  [[nodiscard]] std::optional<double> last() const { return pushed_; }

 private:
  std::optional<Motion> motion_;
  double time_ = 0;               // of motion_
  double told_ = 0;               // when motion_'s rates were
  std::optional<double> pushed_;  // with rates other than 0
};

}  // namespace hc::gaze
