// SPDX-License-Identifier: Apache-2.0
#include <gaze/follower.h>

#include <cmath>

#include <Eigen/LU>

namespace hc::gaze {

void Follower::Axis::begin(double angle, const FollowerOptions& options) {
  state = {angle, 0};
  // Of the rate nothing is known yet: anything up to some rad/s.
  covariance << options.noise * options.noise, 0, 0, 4;
}

void Follower::Axis::step(double dt, const FollowerOptions& options) {
  Eigen::Matrix2d move;
  move << 1, dt, 0, 1;
  state = move * state;
  const double q = options.acceleration * options.acceleration;
  // An acceleration that is constant in a step, another in the next.
  Eigen::Matrix2d disturbance;
  disturbance << dt * dt * dt * dt / 4, dt * dt * dt / 2, dt * dt * dt / 2, dt * dt;
  covariance = move * covariance * move.transpose() + q * disturbance;
}

void Follower::Axis::correct(double angle, const FollowerOptions& options) {
  const double variance = covariance(0, 0) + options.noise * options.noise;
  const Eigen::Vector2d gain = covariance.col(0) / variance;
  state += gain * (angle - state(0));
  covariance -= gain * covariance.row(0);
}

void Follower::see(double time, const Angles& angles) {
  if (last_ && time <= *last_) return;
  if (!last_ || time - *last_ > options_.gap) {
    pan_.begin(angles.pan, options_);
    tilt_.begin(angles.tilt, options_);
  } else {
    const double dt = time - *last_;
    for (auto* axis : {&pan_, &tilt_}) axis->step(dt, options_);
    pan_.correct(angles.pan, options_);
    tilt_.correct(angles.tilt, options_);
  }
  last_ = time;
}

std::optional<Motion> Follower::at(double time) const {
  if (!last_) return std::nullopt;
  const double dt = time - *last_;
  return Motion{{pan_.state(0) + dt * pan_.state(1), tilt_.state(0) + dt * tilt_.state(1)},
                pan_.state(1),
                tilt_.state(1)};
}

}  // namespace hc::gaze
