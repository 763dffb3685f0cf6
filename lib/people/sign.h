// SPDX-License-Identifier: Apache-2.0
#pragma once
// Signs that a hand makes, told by its bent and straight fingers. Pure.

#include <chrono>
#include <optional>

#include <hc/base/time.h>
#include <people/hand.h>

namespace hc::people {

enum class Sign {
  None,
  Open,     ///< all fingers straight and up: stop
  Fist,     ///< all fingers bent
  Point,    ///< the index finger alone, or with the middle finger beside it
  Victory,  ///< the index and the middle finger, apart
  ThumbUp,
};

/// The sign of a hand, by its points in space. A camera that is not upright sees other signs.
Sign sign_of(const Hand& hand);

/// Tells when a hand has held a sign. Times are those of images; where they jump, it starts again.
///
///     if (const auto held = hold.update(time, sign_of(hand))) …  // once for each time it is made
class SignHold {
 public:
  static constexpr std::chrono::milliseconds kHold{300};
  /// How long a sign may be mistaken for another in between; where it commands nothing, longer.
  static constexpr std::chrono::milliseconds kGap{150}, kLongGap{300};
  /// Maximum time between two images.
  static constexpr std::chrono::milliseconds kSilence{1000};

  explicit SignHold(std::chrono::milliseconds hold = kHold, std::chrono::milliseconds gap = kGap)
      : hold_(hold), gap_(gap) {}

  /// Takes the sign in an image.
  /// @returns a sign, once, that was held for so long.
  std::optional<Sign> update(Time time, Sign sign);
  /// The sign that is held now.
  [[nodiscard]] Sign held() const { return is_told_ ? held_.sign : Sign::None; }

 private:
  struct Seen {
    Sign sign = Sign::None;
    Time since{}, last{};
  };
  std::chrono::milliseconds hold_, gap_;
  Seen held_, other_;  // the sign, and what it was taken for since
  bool is_told_ = false;
};

}  // namespace hc::people
