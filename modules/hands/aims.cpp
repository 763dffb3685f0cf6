// SPDX-License-Identifier: Apache-2.0
#include "aims.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include <hc/base/median.h>

void Aims::add(const Aim& aim) {
  // Where time goes back, its source has started again.
  if (!waiting_.empty() && aim.time < waiting_.back().time) waiting_.clear();
  waiting_.push_back(aim);
  if (waiting_.size() > kMost) waiting_.pop_front();
}

std::optional<Aim> Aims::take(hc::Time time) {
  std::optional<Aim> nearest;
  while (!waiting_.empty()) {
    const Aim& next = waiting_.front();
    const auto apart = std::chrono::abs(next.time - time);
    if (nearest && apart > std::chrono::abs(nearest->time - time)) break;
    if (next.time - time > kApart) break;
    if (apart <= kApart) nearest = next;
    waiting_.pop_front();
  }
  return nearest;
}

void SteadyAim::add(const Aim& aim) {
  last_.push_back(aim);
  std::erase_if(last_,
                [&](const Aim& other) { return std::chrono::abs(aim.time - other.time) > kWhile; });
}

std::optional<Aim> SteadyAim::find() const {
  std::vector<Aim> aims;
  std::copy_if(last_.begin(), last_.end(), std::back_inserter(aims),
               [](const Aim& aim) { return aim.ray.is_from_eye; });
  if (aims.empty()) aims.assign(last_.begin(), last_.end());
  if (aims.size() < kLeast) return std::nullopt;
  std::optional<Aim> best;
  double least = kSpread;
  for (const Aim& aim : aims) {
    std::vector<double> angles;
    angles.reserve(aims.size());
    for (const Aim& other : aims)
      angles.push_back(
          std::acos(std::clamp(aim.ray.direction.dot(other.ray.direction), -1.0, 1.0)));
    const double apart = hc::median(std::move(angles));
    if (apart >= least) continue;
    least = apart;
    best = aim;
  }
  if (best) best->time = last_.back().time;
  return best;
}
