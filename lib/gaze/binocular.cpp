// SPDX-License-Identifier: Apache-2.0
#include <gaze/binocular.h>

#include <cstdlib>

namespace hc::gaze {

std::optional<Eigen::Vector3d> Binocular::see(const Eyes& eyes, Side side, std::int64_t time,
                                              const Eigen::Vector2d& pixel, std::int64_t alone,
                                              double distance) {
  // How far the pictures of a pair may be apart.
  constexpr std::int64_t kPair = 1'000'000;  // [ns]
  (side == Side::Left ? left_ : right_) = Sighting{time, pixel};
  const auto& other = side == Side::Left ? right_ : left_;
  if (other && std::abs(other->time - time) <= kPair) {
    const auto p_head = eyes.place_of(left_->pixel, right_->pixel);
    if (p_head) range_ = p_head->norm();
    return p_head;
  }
  // Its partner comes yet, unless this eye alone sees it.
  if (other && std::abs(time - other->time) < alone) return std::nullopt;
  return eyes.place(side) + (range_ > 0 ? range_ : distance) * eyes.direction(side, pixel);
}

}  // namespace hc::gaze
