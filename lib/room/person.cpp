// SPDX-License-Identifier: Apache-2.0
#include <room/person.h>

#include <algorithm>
#include <cmath>

namespace hc::room {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Vector3d shoulder(const Look& look, int side) {
  return {-0.02, side_sign(side) * 0.185 * look.wide, look.tall - 0.245};
}

Isometry3d wrist(const Vector3d& place, const Vector3d& fingers, const Vector3d& back) {
  Eigen::Matrix3d axes;
  axes.col(2) = -fingers.normalized();
  axes.col(0) = back.cross(axes.col(2)).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return Eigen::Translation3d(place) * Isometry3d(axes);
}

Isometry3d hanging(const Look& look, int side) {
  const double out = side_sign(side);
  return wrist(shoulder(look, side) + Vector3d(0.04, out * 0.07, -0.52), {0.1, 0, -1}, {0, out, 0});
}

Isometry3d shown(const Look& look, int side, Sign sign) {
  const double out = side_sign(side);
  if (sign == Sign::Thumb)
    return wrist(shoulder(look, side) + Vector3d(0.34, out * 0.05, -0.12), {0.4, -0.9 * out, 0},
                 {0.9, 0.4 * out, 0});
  return wrist(shoulder(look, side) + Vector3d(0.28, out * 0.14, -0.04), {0, 0, 1}, {-1, 0, 0});
}

Vector3d elbow(const Vector3d& shoulder, const Vector3d& wrist, const Vector3d& outwards) {
  const Vector3d along = wrist - shoulder;
  const double reach = std::clamp(along.norm(), 0.05, kUpperArm + kForearm);
  const Vector3d ahead = along.normalized();
  // The law of cosines gives how far the elbow is along the line, and how far off it.
  const double way = (reach * reach + kUpperArm * kUpperArm - kForearm * kForearm) / (2 * reach);
  const double off = std::sqrt(std::max(0.0, kUpperArm * kUpperArm - way * way));
  const Vector3d bent = 0.5 * outwards - Vector3d::UnitZ();
  const Vector3d across = bent - bent.dot(ahead) * ahead;
  return shoulder + way * ahead + off * across.normalized();
}

}  // namespace hc::room
