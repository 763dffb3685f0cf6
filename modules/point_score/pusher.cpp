// SPDX-License-Identifier: Apache-2.0
#include "pusher.h"

#include <algorithm>
#include <cmath>

#include <hc/base/format.h>

namespace {

constexpr double kStill = 1e-6;  // a head at rest moves less [rad]

double way(const hc::gaze::Angles& a, const hc::gaze::Angles& b) {
  return std::max(std::abs(a.pan - b.pan), std::abs(a.tilt - b.tilt));
}

}  // namespace

double Pusher::moving_since(double way, const hc::gaze::Brakes& unit) {
  return (std::sqrt(unit.base * unit.base + 2 * unit.acceleration * way) - unit.base) /
         unit.acceleration;
}

double Pusher::random(double least, double most) {
  return least + (most - least) * static_cast<double>(random_() >> 11) * 0x1p-53;
}

std::optional<Pusher::Stick> Pusher::look(double time, double rate) {
  if (!move(time)) {
    const bool is_out = stick_.left != 0 || stick_.down != 0;
    if (!is_out || time - sent_ < 1 / rate) return std::nullopt;
  }
  sent_ = time;
  return stick_;
}

bool Pusher::move(double time) {
  if (pushed_) {
    const bool is_over = moved_ ? time >= release_ : time - *pushed_ > options_.timeout;
    if (!is_over) return false;
    pushed_.reset();
    still_since_ = time;
    rest_ = random(0.2, 0.8);  // sometimes long enough for the bid for the head to end
    stick_ = {};
    return true;
  }
  if (!rests_at_ || pushes_ >= options_.count || time - still_since_ < rest_ ||
      heard_ < still_since_ + rest_ / 2)
    return false;
  // Towards the centre, so that the unit never reaches its limits.
  const double size = random(0.3, 1), share = random(-0.5, 0.5);
  stick_.left = rests_at_->pan > 0 ? -size : size;
  stick_.down = (rests_at_->tilt > 0 ? -1 : 1) * std::abs(share) * size;
  pushed_ = time;
  release_ = time + random(0.2, 0.5);
  moved_ = false;
  from_ = *rests_at_;
  ++pushes_;
  return true;
}

void Pusher::take(double time, const hc::gaze::Angles& angles) {
  heard_ = time;
  if (!rests_at_ || way(angles, *rests_at_) > kStill) {
    rests_at_ = angles;
    still_since_ = std::max(still_since_, time);
  }
  if (!pushed_ || moved_ || time <= *pushed_) return;
  const double moved = way(angles, from_);
  if (moved < options_.min_motion) return;
  moved_ = true;
  delays_.push_back(time - moving_since(moved, options_.unit) - *pushed_);
}

Pusher::Score Pusher::score() const {
  if (delays_.empty()) return {.pushes = pushes_};
  auto sorted = delays_;
  std::ranges::sort(sorted);
  const std::size_t n = sorted.size();
  return {(sorted[(n - 1) / 2] + sorted[n / 2]) / 2, sorted.back(), n, pushes_};
}

std::array<double, 4> Pusher::Score::numbers() const {
  return {median, max, static_cast<double>(moved), static_cast<double>(pushes)};
}

std::string Pusher::Score::text() const {
  return hc::format("stick to first motion {:.1f} ms median, {:.1f} ms at most, of {} of {} pushes",
                    1000 * median, 1000 * max, moved, pushes);
}
