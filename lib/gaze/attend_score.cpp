// SPDX-License-Identifier: Apache-2.0
#include <gaze/attend_score.h>

#include <algorithm>
#include <cmath>

#include <hc/base/format.h>

namespace hc::gaze {
namespace {

constexpr double kVisible = 0.5;  // least visible share of a target
constexpr double kInTime = 1.0;   // to look at one who speaks [s]
constexpr double kDegrees = 180 / M_PI;

const TruePerson* wanted(const std::vector<TruePerson>& people) {
  const TruePerson* best = nullptr;
  for (const auto& person : people) {
    if (person.visible < kVisible && !person.speaks) continue;
    const bool is_better = best == nullptr || (person.speaks && !best->speaks) ||
                           (person.speaks == best->speaks && person.distance < best->distance);
    if (is_better) best = &person;
  }
  return best;
}

}  // namespace

void Attending::see(double time, const std::vector<TruePerson>& people) {
  if (const auto* person = wanted(people))
    samples_.push_back({time, person->number, person->speaks, person->error});
}

double Attending::duration() const {
  return samples_.empty() ? 0 : samples_.back().time - samples_.front().time;
}

std::optional<double> Attending::settled() const {
  std::optional<double> since;
  for (const auto& sample : samples_) {
    if (sample.error.norm() > within_)
      since.reset();
    else if (!since)
      since = sample.time - samples_.front().time;
  }
  return since;
}

void Attending::score_turns(AttendScore& score) const {
  for (std::size_t i = 1; i < samples_.size(); ++i) {
    const auto& begin = samples_[i];
    const bool is_turn =
        begin.speaks && (begin.person != samples_[i - 1].person || !samples_[i - 1].speaks);
    if (!is_turn || begin.time + kInTime > samples_.back().time) continue;
    ++score.turns;
    for (std::size_t k = i; k < samples_.size(); ++k) {
      const auto& later = samples_[k];
      if (later.time > begin.time + kInTime || later.person != begin.person) break;
      if (later.error.norm() > within_) continue;
      ++score.right_turns;
      break;
    }
  }
}

AttendScore Attending::score() const {
  AttendScore score;
  double sum = 0;
  int count = 0;
  for (const auto& sample : samples_) {
    if (!score.on_target && sample.error.norm() <= within_)
      score.on_target = sample.time - samples_.front().time;
    if (!score.on_target) continue;
    sum += sample.error.squaredNorm();
    ++count;
    const Eigen::Vector2d first = samples_.front().error;
    if (first.norm() > within_)
      score.overshoot = std::max(score.overshoot, -sample.error.dot(first.normalized()));
  }
  if (count > 0) score.rms = std::sqrt(sum / count);
  score.settled = settled();
  score_turns(score);
  return score;
}

std::array<double, 6> AttendScore::numbers() const {
  return {rms,           on_target.value_or(-1), overshoot, settled.value_or(-1),
          double(turns), double(right_turns)};
}

std::string AttendScore::text() const {
  if (!on_target) return "the head never looked at a person: are their faces found?";
  const std::string stays =
      settled ? hc::format("settled after {:.2f} s", *settled) : std::string("never settled");
  return hc::format(
      "RMS error {:.2f}°, on target after {:.2f} s, overshoot {:.2f}°, {}, wrong in {} of {} turns "
      "of those who spoke",
      rms * kDegrees, *on_target, overshoot * kDegrees, stays, turns - right_turns, turns);
}

}  // namespace hc::gaze
