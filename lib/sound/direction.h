// SPDX-License-Identifier: Apache-2.0
#pragma once
// Level and direction of stereo sound. Pure.

#include <cstdint>
#include <optional>
#include <span>

namespace hc::audio {

struct Direction {
  double level = 0;           ///< root of the mean square, both ears; 1 is full scale
  std::optional<double> pan;  ///< > 0: from the left [rad, −π/2 … π/2]; nothing if
                              ///< the ears hear different sounds
};

/// The level of a piece of sound, and its direction from the delay between the ears. Cannot
/// distinguish front and back.
///
/// @param stereo  left and right interleaved. @param rate  of frames [Hz].
/// @param base  distance between the ears [m].
/// Source: Knapp and Carter, The generalized correlation method for estimation of time delay, 1976
/// (without weights).
/// Cost: 20 µs for 20 ms at 16 kHz.
Direction hear(std::span<const std::int16_t> stereo, int rate, double base);

}  // namespace hc::audio
