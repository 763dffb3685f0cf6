// SPDX-License-Identifier: Apache-2.0
#include <room/sounds.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hc::room {

namespace {

constexpr double kPeriod = 0.5, kLength = 0.15;         // [s]
constexpr double kFirstPitch = 500, kLastPitch = 2000;  // [Hz]
constexpr double kLoudness = 8000;                      // at 1 m, of 32767

}  // namespace

double source_sound(double t) {
  if (t < 0) return 0;
  const double since = std::fmod(t, kPeriod);
  if (since >= kLength) return 0;
  using std::numbers::pi;
  const double turns =
      kFirstPitch * since + (kLastPitch - kFirstPitch) * since * since / (2 * kLength);
  const double swell = std::sin(pi * since / kLength);
  return swell * swell * std::sin(2 * pi * turns);
}

void hear(std::int64_t first, double distance, std::span<std::int16_t> samples,
          std::size_t stride) {
  const double gain = kLoudness / std::max(distance, 0.1), delay = distance / kSpeedOfSound;
  for (std::size_t i = 0; i * stride < samples.size(); ++i) {
    const double t = static_cast<double>(first + static_cast<std::int64_t>(i)) / kSoundRate - delay;
    samples[i * stride] = static_cast<std::int16_t>(
        std::lround(std::clamp(gain * source_sound(t), -32768.0, 32767.0)));
  }
}

}  // namespace hc::room
