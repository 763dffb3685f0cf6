// SPDX-License-Identifier: Apache-2.0
#pragma once
// How loud a piece of stereo sound is, and from which side it comes. Pure.

#include <cstdint>
#include <optional>
#include <span>

namespace hc::audio {

struct Direction {
  double level = 0;           ///< root of the mean square, both ears; 1 is full scale
  std::optional<double> pan;  ///< > 0: from the left; nothing for what both ears hear differently
                              ///< [rad, −π/2 … π/2]
};

/// The level of a piece of sound, and its direction by the time between the ears. A source behind
/// the head cannot be distinguished from one in front of it.
///
/// @param stereo  left and right in turns. @param rate  frames a second [Hz].
/// @param base  distance between the ears [m].
/// Source: Knapp and Carter, The generalized correlation method for estimation of time delay, 1976
/// (without weights).
/// Cost: 20 µs for 20 ms at 16 kHz.
Direction hear(std::span<const std::int16_t> stereo, int rate, double base);

}  // namespace hc::audio
