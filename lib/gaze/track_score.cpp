// SPDX-License-Identifier: Apache-2.0
#include <gaze/track_score.h>

#include <cmath>

namespace hc::gaze {

TrackScore score_track(const std::vector<TrackSample>& samples, double within) {
  constexpr double kSeen = 0.5, kHidden = 0.1, kGrace = 1.0;
  enum class Ball { Hidden, Sought, Followed } ball = Ball::Hidden;
  TrackScore score;
  double since = 0, sum = 0;
  bool is_first = true;
  auto settle = [&](double took) {
    if (is_first && took >= 0) score.acquired = took;
    if (!is_first) score.again.push_back(took);
    is_first = false;
  };
  for (const auto& sample : samples) {
    if (sample.share <= kHidden) {
      if (ball == Ball::Sought && !is_first) settle(-1);
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
  if (ball == Ball::Sought && !is_first) settle(-1);
  if (score.samples > 0) score.rms = std::sqrt(sum / static_cast<double>(score.samples));
  return score;
}

}  // namespace hc::gaze
