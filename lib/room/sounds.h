// SPDX-License-Identifier: Apache-2.0
#pragma once
// The sound of a source in the room at two ears. Pure.

#include <cstdint>
#include <span>

#include <Eigen/Core>

namespace hc::room {

inline constexpr std::int32_t kSoundRate = 16000;  ///< sample frames a second
inline constexpr double kSpeedOfSound = 343;       ///< in air of 20 °C [m/s]

/// The source: a chirp from 500 to 2000 Hz of 0.15 s, twice a second, with amplitude 1.
///
/// @param t  since the start [s]; silent before 0.
double source_sound(double t);

/// The sound at an ear: delayed and attenuated by its distance.
///
/// @param first  number of the first sample.
/// @param distance  from ear to source; the gain is limited below 0.1 m [m].
/// @param[out] samples  i16; every `stride`-th is written.
void hear(std::int64_t first, double distance, std::span<std::int16_t> samples, std::size_t stride);

}  // namespace hc::room
