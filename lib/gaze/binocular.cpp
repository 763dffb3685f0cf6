// SPDX-License-Identifier: Apache-2.0
#include <gaze/binocular.h>

#include <utility>

namespace hc::gaze {

using namespace std::chrono_literals;

std::optional<Eigen::Vector3d> Binocular::see(const Eyes& eyes, Side side, Time time,
                                              const Eigen::Vector2d& pixel, double distance) {
  // Maximum time between the images of a pair.
  constexpr std::chrono::nanoseconds kPair = 1ms;
  // Maximum delay of one eye.
  constexpr std::chrono::nanoseconds kLate = 1s;
  auto& own = side == Side::Left ? left_ : right_;
  const auto& other = side == Side::Left ? right_ : left_;
  const auto before = std::exchange(own, Sighting{time, pixel});
  if (other && std::chrono::abs(other->time - time) <= kPair) {
    const auto p_head = eyes.place_of(left_->pixel, right_->pixel);
    if (p_head) range_ = p_head->norm();
    return p_head;
  }
  const auto period = before ? std::chrono::abs(time - before->time) : kLate;
  // No sums, which could overflow.
  if (other && other->time - time < kLate && (time - other->time) / 3 < period) return std::nullopt;
  return eyes.place(side) + (range_ > 0 ? range_ : distance) * eyes.direction(side, pixel);
}

}  // namespace hc::gaze
