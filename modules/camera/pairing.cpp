// SPDX-License-Identifier: Apache-2.0
#include "pairing.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

namespace {

constexpr std::size_t kPeriods = 7;
// Above 0.5, so that jitter does not break pairs of cameras half a period apart.
constexpr double kTolerance = 0.55;

}  // namespace

std::optional<std::chrono::nanoseconds> Pairing::Side::period() const {
  if (periods.empty()) return {};
  std::vector sorted(periods.begin(), periods.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted[sorted.size() / 2];
}

void Pairing::add(std::size_t side, Frame frame) {
  Side& mine = sides_.at(side);
  if (frame.time < mine.last) mine = {};
  if (mine.last != hc::Time()) mine.periods.push_back(frame.time - mine.last);
  if (mine.periods.size() > kPeriods) mine.periods.pop_front();
  mine.last = frame.time;
  mine.waiting.push_back(std::move(frame));
  if (mine.waiting.size() > kMostWaiting) mine.waiting.pop_front();
}

std::optional<std::array<Frame, 2>> Pairing::take() {
  auto& left = sides_[0].waiting;
  auto& right = sides_[1].waiting;
  while (!left.empty() && !right.empty()) {
    Side& behind = left.front().time <= right.front().time ? sides_[0] : sides_[1];
    const auto difference = std::chrono::abs(left.front().time - right.front().time);
    const auto period = behind.period();
    const bool is_nearest = period && hc::seconds(difference) <= kTolerance * hc::seconds(*period);
    if (difference.count() == 0 || is_nearest) {
      std::array<Frame, 2> pair{std::move(left.front()), std::move(right.front())};
      left.pop_front();
      right.pop_front();
      return pair;
    }
    // The next image of the side behind is closer; if its period is unknown, wait for one.
    if (!period && behind.waiting.size() < 2) return {};
    behind.waiting.pop_front();
  }
  return {};
}
