// SPDX-License-Identifier: Apache-2.0
#pragma once
// Signs that are commands: held for longer, and still. Pure: times come from the caller.

#include <chrono>
#include <optional>

#include <Eigen/Core>

#include <people/sign.h>

namespace hc::people {

/// Tells when a hand has held a sign still, as one does who means the robot: a hand that waves, or
/// passes by, does not.
class HandCommand {
 public:
  static constexpr std::chrono::milliseconds kHold{500};
  /// How far the hand may move meanwhile, as a share of the length of its palm.
  static constexpr double kStill = 0.35;
  /// Maximum time between two images, since a hand may have moved to and fro in between.
  static constexpr std::chrono::milliseconds kUnseen{250};

  /// Takes the sign in an image.
  /// @param towards  direction of the hand in a frame that does not turn with the head, of
  /// length 1.
  /// @param palm  length of the palm. [rad] Both do not matter for a hand without a sign.
  /// @returns a sign, once, that was held still for kHold.
  std::optional<Sign> update(Time time, Sign sign, const Eigen::Vector3d& towards, double palm);
  /// The command that the hand still holds.
  [[nodiscard]] Sign held() const { return hold_.held(); }

 private:
  SignHold hold_{kHold};
  Time last_;
  Eigen::Vector3d from_ = Eigen::Vector3d::Zero();  // where the hand was at first
};

}  // namespace hc::people
