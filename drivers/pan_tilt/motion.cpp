// SPDX-License-Identifier: Apache-2.0
#include <drivers/pan_tilt/motion.h>

#include <algorithm>
#include <cmath>

#include <hc/base/check.h>

namespace hc::pan_tilt {

Motion::Motion(double position, const Pace& pace)
    : pace_(pace), target_(position), end_position_(position) {
  HC_CHECK(pace.speed > 0 && pace.acceleration > 0, pace.speed, pace.acceleration);
}

Motion::State Motion::Leg::after(double seconds) const {
  return {position + (speed + acceleration * seconds / 2) * seconds,
          speed + acceleration * seconds};
}

Motion::State Motion::at(double time) const {
  for (std::size_t i = count_; i-- > 0;) {
    const Leg& leg = legs_[i];
    if (time < leg.begin && i > 0) continue;
    const double seconds = std::max(0.0, time - leg.begin);
    if (seconds < leg.duration) return leg.after(seconds);
    break;
  }
  return {end_position_, 0};
}

/// Starts a new plan from a state.
void Motion::start(double time, const State& state) {
  count_ = 0;
  end_time_ = time;
  end_position_ = state.position;
  end_speed_ = state.speed;
}

void Motion::add(double speed, double acceleration, double duration) {
  if (!(duration > 0)) return;
  const Leg leg = {end_time_, duration, end_position_, speed, acceleration};
  const State state = leg.after(duration);
  legs_.at(count_++) = leg;
  end_time_ += duration;
  end_position_ = state.position;
  end_speed_ = state.speed;
}

/// Brakes to the base speed, from which the motor stops at once.
void Motion::brake() {
  const double excess = std::abs(end_speed_) - std::min(pace_.base, pace_.speed);
  add(end_speed_, std::copysign(pace_.acceleration, -end_speed_), excess / pace_.acceleration);
  end_speed_ = 0;
}

/// From the state after the last leg to the target.
void Motion::plan() {
  const double a = pace_.acceleration, base = std::min(pace_.base, pace_.speed);
  auto way_to_brake = [&](double speed) {
    return std::max(0.0, (speed * speed - base * base) / (2 * a));
  };
  const bool is_away = (target_ - end_position_) * end_speed_ < 0;
  if (is_away || way_to_brake(end_speed_) > std::abs(target_ - end_position_)) brake();
  const double way = std::abs(target_ - end_position_);
  if (way > 0) {
    const double sign = target_ > end_position_ ? 1 : -1;
    const double first = std::max(std::abs(end_speed_), base);
    // Peak speed without a speed limit: way = (top² - first²) / 2a + (top² - base²) / 2a.
    const double top =
        std::min(std::max(first, pace_.speed),
                 std::sqrt(std::max(0.0, (2 * a * way + first * first + base * base) / 2)));
    const double cruise = std::min(top, pace_.speed);
    // Accelerates to `cruise`, or slows down to it if the speed limit was lowered.
    const double change = std::abs(cruise - first) / a;
    add(sign * first, cruise > first ? sign * a : -sign * a, change);
    const double left = std::abs(target_ - end_position_) - way_to_brake(cruise);
    add(sign * cruise, 0, cruise > 0 ? left / cruise : 0);
    add(sign * cruise, -sign * a, (cruise - base) / a);
  }
  end_position_ = target_;  // removes rounding errors
  end_speed_ = 0;
}

void Motion::go(double time, double target) {
  start(time, at(time));
  target_ = target;
  plan();
}

void Motion::set_pace(double time, const Pace& pace) {
  HC_CHECK(pace.speed > 0 && pace.acceleration > 0, pace.speed, pace.acceleration);
  const State state = at(time);
  pace_ = pace;
  if (time >= end_time_) return;  // at rest
  start(time, state);
  plan();
}

void Motion::halt(double time) {
  start(time, at(time));
  brake();
  target_ = end_position_;
}

}  // namespace hc::pan_tilt
