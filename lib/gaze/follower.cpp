// SPDX-License-Identifier: Apache-2.0
#include <gaze/follower.h>

#include <algorithm>
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

bool Follower::Axis::can_be(double angle, const FollowerOptions& options) const {
  constexpr double kSigmas = 8;
  constexpr double kAlways = 0.05;  // [rad]
  const double variance = covariance(0, 0) + options.noise * options.noise;
  return std::abs(angle - state(0)) <= std::max(kAlways, kSigmas * std::sqrt(variance));
}

void Follower::Axis::correct(double angle, const FollowerOptions& options) {
  const double variance = covariance(0, 0) + options.noise * options.noise;
  const Eigen::Vector2d gain = covariance.col(0) / variance;
  state += gain * (angle - state(0));
  covariance -= gain * covariance.row(0);
}

void Follower::see(double time, const Angles& angles) {
  if (last_ && time <= *last_ && *last_ - time <= options_.gap) return;
  bool is_same = last_ && std::abs(time - *last_) <= options_.gap;
  // Half a turn to either side is the same place.
  const double pan =
      is_same ? pan_.state(0) + std::remainder(angles.pan - pan_.state(0), 2 * M_PI) : angles.pan;
  if (is_same) {
    for (auto* axis : {&pan_, &tilt_}) axis->step(time - *last_, options_);
    is_same = pan_.can_be(pan, options_) && tilt_.can_be(angles.tilt, options_);
  }
  last_ = time;
  if (is_same) {
    pan_.correct(pan, options_);
    tilt_.correct(angles.tilt, options_);
  } else {
    pan_.begin(angles.pan, options_);
    tilt_.begin(angles.tilt, options_);
  }
}

std::optional<Motion> Follower::at(double time) const {
  if (!last_) return std::nullopt;
  const double dt = std::min(time - *last_, options_.horizon);
  const double moves = time - *last_ > options_.horizon ? 0 : 1;
  return Motion{{pan_.state(0) + dt * pan_.state(1), tilt_.state(0) + dt * tilt_.state(1)},
                moves * pan_.state(1),
                moves * tilt_.state(1)};
}

}  // namespace hc::gaze
