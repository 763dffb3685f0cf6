// SPDX-License-Identifier: Apache-2.0
#include "pairing.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>
#include <vector>

namespace {

constexpr std::size_t kTimes = 12;
// Times may be those of arrival, in bursts: a period is the mean of this many.
constexpr std::size_t kMean = 4;
// Above 0.5, so that jitter does not break pairs of cameras half a period apart.
constexpr double kTolerance = 0.55;

}  // namespace

/// The median of the means, so that a missing image does not matter.
std::optional<std::chrono::nanoseconds> Pairing::Side::period() const {
  if (times.size() < 2) return {};
  const std::size_t step = std::min(kMean, times.size() - 1);
  std::vector<std::chrono::nanoseconds> means;
  for (std::size_t i = step; i < times.size(); ++i)
    means.push_back((times[i] - times[i - step]) / static_cast<std::int64_t>(step));
  std::sort(means.begin(), means.end());
  return means[means.size() / 2];
}

bool Pairing::Side::starves() const {
  return unpaired >= kMostWaiting && times.back() - unpaired_since >= kStarving;
}

std::optional<std::chrono::nanoseconds> Pairing::starves_by() const {
  if (!sides_[0].starves() || !sides_[1].starves()) return {};
  return std::chrono::abs(sides_[0].times.back() - sides_[1].times.back());
}

void Pairing::add(std::size_t side, Frame frame) {
  Side& mine = sides_.at(side);
  if (!mine.times.empty() && frame.time < mine.times.back()) mine = {};
  mine.times.push_back(frame.time);
  if (mine.times.size() > kTimes) mine.times.pop_front();
  if (mine.unpaired++ == 0) mine.unpaired_since = frame.time;
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
      for (auto& side : sides_) side.unpaired = 0;
      return pair;
    }
    // The next image of the side behind is closer; if its period is unknown, wait for one.
    if (!period && behind.waiting.size() < 2) return {};
    behind.waiting.pop_front();
  }
  return {};
}
