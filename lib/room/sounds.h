// SPDX-License-Identifier: Apache-2.0
#pragma once
// Sounds in the room, and how an ear hears them. Pure.

#include <cstdint>
#include <functional>
#include <span>

#include <Eigen/Core>

namespace hc::room {

inline constexpr std::int32_t kSoundRate = 16000;  ///< sample frames a second
inline constexpr double kSpeedOfSound = 343;       ///< in air of 20 °C [m/s]

/// A source: its place in the world [m], and its sound with amplitude 1 at a time [s].
struct Source {
  Eigen::Vector3d place;
  std::function<double(double t)> sound;
};

/// A loudspeaker's: a chirp from 500 to 2000 Hz of 0.15 s, twice a second.
///
/// @param t  since the start [s]; silent before 0.
double chirps(double t);

/// A voice: vowels, about four syllables a second.
///
/// @param pitch  [Hz].
double voice(double pitch, double t);

/// Adds the sound at an ear: delayed and attenuated by its distance.
///
/// @param first  number of the first sample.
/// @param distance  from ear to source; the gain is limited below 0.1 m [m].
/// @param samples  i16; every `stride`-th is changed.
void hear(std::int64_t first, double distance, const std::function<double(double t)>& sound,
          std::span<std::int16_t> samples, std::size_t stride);

}  // namespace hc::room
