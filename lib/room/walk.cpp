// SPDX-License-Identifier: Apache-2.0
#include <room/walk.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include <room/progress.h>

namespace hc::room {

namespace {

constexpr double kAcceleration = 2.0;                      // [m/s²]
constexpr double kTurn = 0.6;                              // duration [s]
constexpr double kShortestRest = 0.4, kLongestRest = 1.4;  // [s]
constexpr double kShortest = 1.2;                          // leg [m]
constexpr double kTwist = 0.35;  // of the chest towards the robot while walking [rad]

}  // namespace

double towards_robot(const Eigen::Vector2d& place) {
  return std::numbers::pi + std::atan2(place.y(), place.x());
}

Walk::Walk(const Lane& lane) : lane_(lane), chance_(lane.seed) {
  legs_.push_back({0, lane.first, lane.first, chance_.next(kShortestRest, kLongestRest)});
}

void Walk::add_leg() {
  const Leg last = legs_.back();
  double to = last.to > 0 ? -kWalkEnd : kWalkEnd;
  while (!lane_.is_whole) {
    to = chance_.next(-kWalkEnd, kWalkEnd);
    if (std::abs(to - last.to) > kShortest) break;
  }
  const double walks = duration(std::abs(to - last.to), kWalkSpeed, kAcceleration);
  const double rests = chance_.next(kShortestRest, kLongestRest);
  legs_.push_back({last.end, last.to, to, last.end + kTurn + walks + kTurn + rests});
}

Walk::Step Walk::at(double t) {
  while (legs_.back().end <= t) add_leg();
  const auto next =
      std::upper_bound(legs_.begin(), legs_.end(), t,
                       [](double time, const Leg& each) { return time < each.begin; });
  const Leg& leg = next == legs_.begin() ? *next : *std::prev(next);
  const double distance = std::abs(leg.to - leg.from), since = t - leg.begin;
  if (distance == 0) {
    const Eigen::Vector2d place(lane_.x, leg.from);
    return {place, towards_robot(place), 0, 0};
  }
  const double sign = leg.to < leg.from ? -1 : 1;
  const auto progress = travel(distance, kWalkSpeed, kAcceleration, since - kTurn);
  const Eigen::Vector2d place(lane_.x, leg.from + sign * progress.way);
  const double facing = towards_robot(place);
  const double along = std::numbers::pi - sign * (std::numbers::pi / 2 - kTwist);
  const double walks = duration(distance, kWalkSpeed, kAcceleration);
  const double turned = ease(since / kTurn) - ease((since - kTurn - walks) / kTurn);
  return {place, facing + turned * (along - facing), progress.speed, progress.way};
}

}  // namespace hc::room
