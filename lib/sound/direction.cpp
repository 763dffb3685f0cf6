// SPDX-License-Identifier: Apache-2.0
#include <sound/direction.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace hc::audio {
namespace {

constexpr double kSpeedOfSound = 343;  // in air of 20 °C [m/s]
constexpr double kAlike = 0.5;         // minimum correlation of one source at both ears

}  // namespace

Direction hear(std::span<const std::int16_t> stereo, int rate, double base) {
  Direction heard;
  const auto frames = static_cast<std::ptrdiff_t>(stereo.size() / 2);
  if (frames == 0 || rate <= 0 || !(base > 0)) return heard;
  const auto at = [&](std::ptrdiff_t frame, int ear) {
    return static_cast<double>(stereo[static_cast<std::size_t>(2 * frame + ear)]);
  };
  double energy = 0;
  for (const double sample : stereo) energy += sample * sample;
  heard.level = std::sqrt(energy / static_cast<double>(stereo.size())) / 32768;

  // Maximum lag of the right ear in frames: that of the base, and one for the parabola.
  const auto most = static_cast<std::ptrdiff_t>(std::ceil(base / kSpeedOfSound * rate)) + 1;
  if (energy <= 0 || frames < 4 * most) return heard;
  std::vector<double> likeness;
  for (auto lag = -most; lag <= most; ++lag) {
    double both = 0, left = 0, right = 0;
    for (auto i = most; i < frames - most; ++i) {
      const double l = at(i, 0), r = at(i + lag, 1);
      both += l * r;
      left += l * l;
      right += r * r;
    }
    likeness.push_back(left > 0 && right > 0 ? both / std::sqrt(left * right) : 0);
  }
  const auto peak = std::max_element(likeness.begin(), likeness.end());
  if (*peak < kAlike || peak == likeness.begin() || peak + 1 == likeness.end()) return heard;
  const double bend = peak[-1] - 2 * *peak + peak[1];
  const double lag = static_cast<double>(peak - likeness.begin() - most) +
                     (bend < 0 ? (peak[-1] - peak[1]) / (2 * bend) : 0);
  heard.pan = std::asin(std::clamp(lag / rate * kSpeedOfSound / base, -1.0, 1.0));
  return heard;
}

}  // namespace hc::audio
