// SPDX-License-Identifier: Apache-2.0
#include <room/screen.h>

#include <cmath>
#include <numbers>

#include <room/ball.h>
#include <room/paint.h>

namespace hc::room {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kWidth = 0.62, kHeight = 0.8, kRadius = 1.95, kMiddle = 0.72;  // [m]

/// Horizontal direction from the robot's axis to the screen.
Vector3d towards() {
  return {std::cos(kScreenAngle), std::sin(kScreenAngle), 0};
}

Vector3d middle() {
  return kRadius * towards() + Vector3d(0, 0, kMiddle);
}

}  // namespace

double share_seen(const Vector3d& ball, const Vector3d& from) {
  // Rays to points of the visible disc.
  constexpr int kRings = 5, kRays = 16;
  const Vector3d along = (ball - from).normalized();
  const Vector3d right = along.unitOrthogonal(), down = along.cross(right);
  const Isometry3d T_screen_world = hang(middle(), kScreenAngle).inverse();
  const Vector3d start = T_screen_world * from;
  int seen = 0;
  for (int ring = 0; ring < kRings; ++ring)
    for (int ray = 0; ray < kRays; ++ray) {
      // Rings of equal area.
      const double radius = kBallRadius * std::sqrt((ring + 0.5) / kRings);
      const double angle = 2 * std::numbers::pi * ray / kRays;
      const Vector3d end =
          T_screen_world * (ball + radius * (std::cos(angle) * right + std::sin(angle) * down));
      const double share = start.z() / (start.z() - end.z());
      const Vector3d hit = start + share * (end - start);
      const bool is_hidden = share > 0 && share < 1 && std::abs(hit.x()) < kWidth / 2 &&
                             std::abs(hit.y()) < kHeight / 2;
      if (!is_hidden) ++seen;
    }
  return static_cast<double>(seen) / (kRings * kRays);
}

void add_screen(Scenery& room) {
  room.add_box({0.02, kWidth, kHeight}, middle() + 0.012 * towards(),
               paint_grains(256, 256, {120, 128, 140}, 40, room.seed() + 11), kScreenAngle);
  room.add_box({0.3, kWidth, 0.32}, kRadius * towards() + Vector3d(0, 0, 0.16),
               paint_grains(128, 128, {100, 100, 104}, 20, room.seed() + 12), kScreenAngle);
}

}  // namespace hc::room
