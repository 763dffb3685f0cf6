// SPDX-License-Identifier: Apache-2.0
#pragma once
// Signs that are commands: held for longer, and still. Pure: times come from the caller.

#include <array>
#include <chrono>
#include <optional>

#include <Eigen/Core>

#include <people/sign.h>

namespace hc::people {

/// Tells when a hand has held a sign still, as one does who means the robot: a hand that waves, or
/// passes by, does not.
class HandCommand {
 public:
  /// Directions of a hand's wrist, middle knuckle, and tip of the middle finger, of length 1, in a
  /// frame that does not turn with the head. All three, since of a hand that waves to and fro along
  /// the line of sight, as beside a body that turns, the knuckle alone hardly moves.
  using Directions = std::array<Eigen::Vector3d, 3>;

  static constexpr std::chrono::milliseconds kHold{500};
  /// How far each of them may move meanwhile, as a share of the length of the palm.
  static constexpr double kStill = 0.25;
  /// Maximum time between two images, since a hand may have moved to and fro in between.
  static constexpr std::chrono::milliseconds kUnseen{250};

  /// Takes the sign in an image. A hold begins halfway between the first image of the hand at rest
  /// and the one before, if that is at most kUnseen earlier.
  /// @param towards  nothing for a hand without a sign.
  /// @returns a sign, once, that was held still for kHold.
  std::optional<Sign> update(Time time, Sign sign, const std::optional<Directions>& towards);
  /// The command that the hand still holds.
  [[nodiscard]] Sign held() const { return hold_.held(); }

 private:
  SignHold hold_{kHold};
  Time last_;
  std::optional<Directions> from_;  // where the hand was at first
};

}  // namespace hc::people
