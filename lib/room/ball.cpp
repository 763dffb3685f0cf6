// SPDX-License-Identifier: Apache-2.0
#include <room/ball.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include <room/progress.h>

namespace hc::room {

namespace {

constexpr double kAcceleration = 1.6;  // [rad/s²]
constexpr double kRest = 0.25;         // at the end of a leg [s]
constexpr double kShortest = 0.5;      // leg [rad]
constexpr double kBounce = 0.3;        // height of a bounce [m]
constexpr double kGravity = 9.81;      // [m/s²]

}  // namespace

Ball::Ball(const BallMotion& motion) : motion_(motion), chance_(motion.seed) {
  const double first = (2 * chance_.next() - 1) * kArcEnd / 2;
  legs_.push_back({0, first, first, kRest});
}

void Ball::add_leg() {
  const Leg last = legs_.back();
  double to = kScreenAngle;
  // Every third rest is behind the screen.
  const bool hides = motion_.kind == "hide" && legs_.size() % 3 == 2;
  while (!hides) {
    to = (2 * chance_.next() - 1) * kArcEnd;
    const bool is_clear = motion_.kind != "hide" || std::abs(to - kScreenAngle) > 0.3;
    if (std::abs(to - last.to) > kShortest && is_clear) break;
  }
  const double travels = duration(std::abs(to - last.to), motion_.speed, kAcceleration);
  legs_.push_back({last.end, last.to, to, last.end + travels + (hides ? motion_.hidden : kRest)});
}

Ball::State Ball::at(double t) {
  double angle = legs_.front().from, rate = 0;
  if (motion_.kind != "still" && motion_.speed > 0) {
    while (legs_.back().end <= t) add_leg();
    const auto leg =
        std::prev(std::upper_bound(legs_.begin(), legs_.end(), t,
                                   [](double time, const Leg& each) { return time < each.begin; }));
    const double sign = leg->to < leg->from ? -1 : 1;
    const auto progress =
        travel(std::abs(leg->to - leg->from), motion_.speed, kAcceleration, t - leg->begin);
    if (leg->to != leg->from) {
      angle = leg->from + sign * progress.way;
      rate = sign * progress.speed;
    }
  }
  double height = 0, climb = 0;
  if (motion_.kind == "bounce") {
    const double rise = std::sqrt(2 * kBounce / kGravity);  // from the bench to the top [s]
    const double since_top = std::fmod(t, 2 * rise) - rise;
    height = kBounce - kGravity * since_top * since_top / 2;
    climb = -kGravity * since_top;
  }
  const double c = std::cos(angle), s = std::sin(angle);
  return {{kArcRadius * c, kArcRadius * s, kArcHeight + kBallRadius + height},
          {-kArcRadius * s * rate, kArcRadius * c * rate, climb}};
}

}  // namespace hc::room
