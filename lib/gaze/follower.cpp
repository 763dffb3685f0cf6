// SPDX-License-Identifier: Apache-2.0
#include <gaze/follower.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <Eigen/LU>

namespace hc::gaze {

void Follower::Filter::begin(double angle, const FollowerOptions& options) {
  state = {angle, 0};
  // The rate is unknown: up to some rad/s.
  covariance << options.noise * options.noise, 0, 0, 4;
}

void Follower::Filter::step(double dt, const FollowerOptions& options) {
  Eigen::Matrix2d move;
  move << 1, dt, 0, 1;
  state = move * state;
  const double q = options.acceleration * options.acceleration;
  // Piecewise constant acceleration.
  Eigen::Matrix2d disturbance;
  disturbance << dt * dt * dt * dt / 4, dt * dt * dt / 2, dt * dt * dt / 2, dt * dt;
  covariance = move * covariance * move.transpose() + q * disturbance;
}

bool Follower::Filter::can_be(double angle, const FollowerOptions& options) const {
  constexpr double kSigmas = 8;
  constexpr double kAlways = 0.05;  // [rad]
  const double variance = covariance(0, 0) + options.noise * options.noise;
  return std::abs(angle - state(0)) <= std::max(kAlways, kSigmas * std::sqrt(variance));
}

void Follower::Filter::correct(double angle, const FollowerOptions& options) {
  const double variance = covariance(0, 0) + options.noise * options.noise;
  const Eigen::Vector2d gain = covariance.col(0) / variance;
  state += gain * (angle - state(0));
  covariance -= gain * covariance.row(0);
}

namespace {

/// A filter that averages over about half a second.
FollowerOptions slow(const FollowerOptions& options) {
  auto slow = options;
  slow.acceleration = options.acceleration / 20;
  slow.noise = std::max(0.05, options.noise);
  return slow;
}

}  // namespace

const Follower::Filter& Follower::Axis::better() const {
  constexpr double kGood = 0.02;   // with a smaller error the quick one is used [rad]
  constexpr double kMargin = 0.6;  // advantage of the quick one
  const bool is_slow = quick_error > kGood * kGood && slow_error < kMargin * quick_error;
  return is_slow ? slow : quick;
}

void Follower::begin(double angle, Axis& axis) const {
  axis = {};
  axis.quick.begin(angle, options_);
  axis.slow.begin(angle, slow(options_));
}

void Follower::step(double dt, Axis& axis) const {
  axis.quick.step(dt, options_);
  axis.slow.step(dt, slow(options_));
}

void Follower::correct(double angle, Axis& axis) const {
  axis.quick.correct(angle, options_);
  axis.slow.correct(angle, slow(options_));
}

void Follower::judge(double time, const Angles& angles) {
  constexpr double kAhead = 0.1;   // prediction time that a head needs [s]
  constexpr double kMemory = 1.0;  // [s]
  while (known_.size() > 1 && known_[1].time <= time - kAhead) known_.pop_front();
  if (known_.empty() || known_.front().time > time - kAhead) return;
  const auto& then = known_.front();
  const double dt = time - then.time, weight = 1 - std::exp(-(time - *last_) / kMemory);
  for (auto [axis, before, angle] :
       {std::tuple(&pan_, &then.pan, angles.pan), {&tilt_, &then.tilt, angles.tilt}}) {
    const double quick = angle - before->quick.after(dt), slow = angle - before->slow.after(dt);
    axis->quick_error += weight * (quick * quick - axis->quick_error);
    axis->slow_error += weight * (slow * slow - axis->slow_error);
  }
}

void Follower::see(double time, const Angles& angles) {
  if (last_ && time <= *last_ && *last_ - time <= options_.gap) return;
  bool is_same = last_ && std::abs(time - *last_) <= options_.gap;
  // Unwrap: −π and π are the same direction.
  const double here = pan_.quick.state(0);
  const double pan = is_same ? here + std::remainder(angles.pan - here, 2 * M_PI) : angles.pan;
  // A target that reverses suddenly still fits the slow filter; one that keeps accelerating fits
  // the quick one, whose bound is limited, as after a pause it would include any leap.
  if (is_same) {
    for (auto* axis : {&pan_, &tilt_}) step(time - *last_, *axis);
    const auto can_be = [&](const Axis& axis, double angle) {
      constexpr double kMost = 0.4;  // about that of the slow filter at rest [rad]
      return (axis.quick.can_be(angle, options_) &&
              std::abs(angle - axis.quick.state(0)) <= kMost) ||
             axis.slow.can_be(angle, slow(options_));
    };
    is_same = can_be(pan_, pan) && can_be(tilt_, angles.tilt);
  }
  if (is_same) {
    judge(time, {pan, angles.tilt});
    for (auto [axis, angle] : {std::pair(&pan_, pan), {&tilt_, angles.tilt}}) {
      const bool has_jumped = !axis->quick.can_be(angle, options_);
      correct(angle, *axis);
      if (has_jumped) axis->quick.begin(angle, options_);
    }
  } else {
    known_.clear();
    begin(angles.pan, pan_);
    begin(angles.tilt, tilt_);
  }
  last_ = time;
  known_.push_back({time, pan_, tilt_});
}

std::optional<Motion> Follower::at(double time) const {
  if (!last_) return std::nullopt;
  const double dt = std::min(time - *last_, options_.horizon);
  const double moves = time - *last_ > options_.horizon ? 0 : 1;
  const auto &pan = pan_.better(), &tilt = tilt_.better();
  return Motion{{pan.after(dt), tilt.after(dt)}, moves * pan.state(1), moves * tilt.state(1)};
}

}  // namespace hc::gaze
