// SPDX-License-Identifier: Apache-2.0
#include <gaze/follow_score.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include <hc/base/check.h>

#include <hc/base/format.h>

namespace hc::gaze {
namespace {

constexpr double kMostBehind = 0.5;  // search range, both ways [s]
constexpr double kStep = 1e-3;       // of the search [s]

/// Mean squared angle between both, with `wanted` delayed by `behind`.
double mean_square(const std::vector<TimedAngles>& wanted, const std::vector<TimedAngles>& follows,
                   double behind) {
  double sum = 0;
  for (const auto& sample : follows) {
    const double error = between(sample.angles, angles_at(wanted, sample.time - behind));
    sum += error * error;
  }
  return sum / static_cast<double>(follows.size());
}

}  // namespace

Angles angles_at(const std::vector<TimedAngles>& samples, double time) {
  HC_CHECK(!samples.empty());
  const auto next = std::lower_bound(samples.begin(), samples.end(), time,
                                     [](const auto& each, double t) { return each.time < t; });
  if (next == samples.begin()) return next->angles;
  if (next == samples.end()) return samples.back().angles;
  const auto& before = *std::prev(next);
  const double share = (time - before.time) / (next->time - before.time);
  return {std::lerp(before.angles.pan, next->angles.pan, share),
          std::lerp(before.angles.tilt, next->angles.tilt, share)};
}

FollowScore score_follow(const std::vector<TimedAngles>& wanted,
                         const std::vector<TimedAngles>& follows, double begin, double end) {
  FollowScore score;
  if (wanted.empty()) return score;
  std::vector<TimedAngles> compared;
  for (const auto& sample : follows)
    if (sample.time >= std::max(begin, wanted.front().time) &&
        sample.time <= std::min(end, wanted.back().time))
      compared.push_back(sample);
  if (compared.empty()) return score;
  score.samples = compared.size();
  score.rms = std::sqrt(mean_square(wanted, compared, 0));
  for (const auto& sample : compared)
    score.max = std::max(score.max, between(sample.angles, angles_at(wanted, sample.time)));

  // The error has one minimum if the delay is short relative to the motion: search coarse to fine.
  double best = 0, least = mean_square(wanted, compared, 0);
  for (double step : {50 * kStep, 10 * kStep, kStep}) {
    const double middle = best, reach = step == 50 * kStep ? kMostBehind : 10 * step;
    const auto steps = static_cast<int>(std::lround(reach / step));
    for (int i = -steps; i <= steps; ++i) {
      const double behind = middle + i * step;
      const double error = mean_square(wanted, compared, behind);
      if (error < least) {
        least = error;
        best = behind;
      }
    }
  }
  score.behind = best;
  return score;
}

std::array<double, 4> FollowScore::numbers() const {
  return {rms, max, behind, static_cast<double>(samples)};
}

std::string FollowScore::text() const {
  constexpr double kDegrees = 180 / M_PI, kMilliseconds = 1000;
  return hc::format("error {:.2f}° RMS, {:.2f}° at most, behind by {:.0f} ms", rms * kDegrees,
                    max * kDegrees, behind * kMilliseconds);
}

}  // namespace hc::gaze
