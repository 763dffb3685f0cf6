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

double chirps(double t) {
  if (t < 0) return 0;
  const double since = std::fmod(t, kPeriod);
  if (since >= kLength) return 0;
  using std::numbers::pi;
  const double turns =
      kFirstPitch * since + (kLastPitch - kFirstPitch) * since * since / (2 * kLength);
  const double swell = std::sin(pi * since / kLength);
  return swell * swell * std::sin(2 * pi * turns);
}

double voice(double pitch, double t) {
  using std::numbers::pi;
  constexpr double kSyllables = 4.1;                    // [Hz]
  constexpr double kWidths[] = {110, 140, 220};         // of the formants [Hz]
  constexpr double kVowels[][3] = {{700, 1200, 2600},   // as in "father"
                                   {300, 2200, 2900},   // "see"
                                   {450, 800, 2400},    // "law"
                                   {550, 1750, 2500}};  // "bed"
  if (t < 0) return 0;
  const double syllable = kSyllables * t;
  const auto number = static_cast<std::uint64_t>(syllable);
  // Another vowel each time, in an order that is not obvious.
  const auto& formants = kVowels[(number * 7 + number / 3) % 4];
  double sum = 0;
  for (int harmonic = 1; harmonic * pitch < 3200; ++harmonic) {
    double strength = 0.02;
    for (int i = 0; i < 3; ++i) {
      const double off = (harmonic * pitch - formants[i]) / kWidths[i];
      strength += 1 / (1 + off * off) / (i + 1);
    }
    sum += strength / std::sqrt(harmonic) * std::sin(2 * pi * harmonic * pitch * t);
  }
  const double swell = std::sin(pi * (syllable - static_cast<double>(number)));
  return std::clamp(0.6 * swell * sum, -1.0, 1.0);
}

void hear(std::int64_t first, double distance, const std::function<double(double t)>& sound,
          std::span<std::int16_t> samples, std::size_t stride) {
  const double gain = kLoudness / std::max(distance, 0.1), delay = distance / kSpeedOfSound;
  for (std::size_t i = 0; i * stride < samples.size(); ++i) {
    const double t = static_cast<double>(first + static_cast<std::int64_t>(i)) / kSoundRate - delay;
    auto& sample = samples[i * stride];
    sample = static_cast<std::int16_t>(
        std::lround(std::clamp(sample + gain * sound(t), -32768.0, 32767.0)));
  }
}

}  // namespace hc::room
