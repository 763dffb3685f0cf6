// SPDX-License-Identifier: Apache-2.0
#include <gaze/track_score.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <hc/base/format.h>

namespace hc::gaze {

TrackScore score_track(const std::vector<TrackSample>& samples, double within) {
  constexpr double kSeen = 0.5, kHidden = 0.1, kGrace = 1.0;
  enum class Ball { Hidden, Sought, Followed } ball = Ball::Hidden;
  TrackScore score;
  double since = 0, sum = 0;
  bool is_first = true;
  double now = 0;
  auto settle = [&](double took) {
    if (is_first && took >= 0) score.acquired = took;
    if (!is_first) score.again.push_back(took);
    is_first = false;
  };
  /// Counts a miss if there was time to acquire the ball before it disappeared or the run ended.
  auto give_up = [&] {
    if (ball == Ball::Sought && !is_first && now - since > kGrace) settle(-1);
  };
  for (const auto& sample : samples) {
    now = sample.time;
    if (sample.share <= kHidden) {
      give_up();
      ball = Ball::Hidden;
    } else if (ball == Ball::Hidden && sample.share >= kSeen) {
      ball = Ball::Sought;
      since = sample.time;
    }
    if (ball == Ball::Sought && sample.error <= within) {
      settle(sample.time - since);
      ball = Ball::Followed;
    }
    const bool is_late = ball == Ball::Sought && sample.time - since > kGrace;
    if (ball == Ball::Followed || is_late) {
      sum += sample.error * sample.error;
      ++score.samples;
    }
  }
  give_up();
  if (score.samples > 0) score.rms = std::sqrt(sum / static_cast<double>(score.samples));
  return score;
}

void Track::begin() {
  if (!std::exchange(has_begun_, true)) samples_.clear();
}

double Track::duration() const {
  return samples_.empty() ? 0 : samples_.back().time - samples_.front().time;
}

double TrackScore::longest() const {
  if (again.empty()) return 0;
  return *std::ranges::min_element(again) < 0 ? -1 : *std::ranges::max_element(again);
}

std::array<double, 5> TrackScore::numbers() const {
  return {rms, acquired.value_or(-1), static_cast<double>(again.size()), longest(),
          static_cast<double>(samples)};
}

std::string TrackScore::text() const {
  const double degrees = rms * 180 / M_PI;
  if (!acquired)
    return hc::format(
        "the ball was never acquired, RMS error {:.2f}° of {} images: can the finder see it "
        "(exposure, colour)?",
        degrees, samples);
  return hc::format(
      "RMS error {:.2f}°, acquired after {:.2f} s, came back {} times, "
      "acquired again after {:.2f} s at most, of {} images",
      degrees, *acquired, again.size(), longest(), samples);
}

}  // namespace hc::gaze
