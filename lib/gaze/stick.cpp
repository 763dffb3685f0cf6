// SPDX-License-Identifier: Apache-2.0
#include <gaze/stick.h>

#include <algorithm>
#include <cmath>

namespace hc::gaze {

void Stick::push(const Angles& rates, double now, const Angles& measured) {
  const bool is_let_go = rates.pan == 0 && rates.tilt == 0;
  if (is_let_go) {
    const bool was_pushed =
        at(now, measured) && (motion_->pan_rate != 0 || motion_->tilt_rate != 0);
    if (!was_pushed) return;
  } else {
    pushed_ = now;
    if (!at(now, measured)) {
      motion_ = Motion{measured};
      time_ = now;
    }
  }
  pushed_at_ = now;
  motion_->pan_rate = rates.pan;
  motion_->tilt_rate = rates.tilt;
}

std::optional<Motion> Stick::at(double now, const Angles& measured) {
  // abs(): also if the clock was set back.
  if (motion_ && std::abs(now - pushed_at_) > kHold) motion_.reset();
  if (!motion_) return std::nullopt;
  constexpr double kReach = 0.1;  // [rad]
  const double dt = now - time_;
  time_ = now;
  auto moved = [&](double at, double by_rate, double from) {
    return std::clamp(at + by_rate * dt, from - kReach, from + kReach);
  };
  motion_->angles = {moved(motion_->angles.pan, motion_->pan_rate, measured.pan),
                     moved(motion_->angles.tilt, motion_->tilt_rate, measured.tilt)};
  return motion_;
}

}  // namespace hc::gaze
