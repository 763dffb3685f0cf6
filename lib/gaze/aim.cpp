// SPDX-License-Identifier: Apache-2.0
#include <gaze/aim.h>

#include <algorithm>
#include <cmath>

namespace hc::gaze {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

Eigen::Quaterniond rotation(const Angles& angles) {
  return AngleAxisd(angles.pan, Vector3d::UnitZ()) * AngleAxisd(angles.tilt, Vector3d::UnitY());
}

Angles angles_of(const Eigen::Quaterniond& R_robot_head) {
  const Vector3d forward = R_robot_head * Vector3d::UnitX();
  return {std::atan2(forward.y(), forward.x()), -std::asin(std::clamp(forward.z(), -1.0, 1.0))};
}

double between(const Angles& a, const Angles& b) {
  const Vector3d one = rotation(a) * Vector3d::UnitX(), other = rotation(b) * Vector3d::UnitX();
  return std::atan2(one.cross(other).norm(), one.dot(other));
}

Angles aim(const Vector3d& p_robot, const Vector3d& eye) {
  Angles angles{std::atan2(p_robot.y(), p_robot.x()),
                -std::atan2(p_robot.z(), p_robot.head<2>().norm())};
  // The eye moves as the head turns; each step leaves eye / distance of the error before.
  constexpr int kSteps = 8;
  for (int i = 0; i < kSteps; ++i) {
    const Vector3d to = rotation(angles).inverse() * p_robot - eye;
    angles.pan += std::atan2(to.y(), to.x());
    angles.tilt -= std::atan2(to.z(), to.head<2>().norm());
    angles.tilt = std::clamp(angles.tilt, -1.5, 1.5);
  }
  return {std::remainder(angles.pan, 2 * M_PI), angles.tilt};
}

Vector3d Eyes::direction(int side, double u, double v) const {
  // From the optical frame (x right, y down, z forward).
  const Vector3d seen(1, -(u - cx) / focal, -(v - cy) / focal);
  return (side > 0 ? R_left : R_right) * seen.normalized();
}

std::optional<Vector3d> Eyes::place_of(const Eigen::Vector2d& left, const Eigen::Vector2d& right,
                                       double gap) const {
  const Vector3d a = direction(1, left.x(), left.y()), b = direction(-1, right.x(), right.y());
  const Vector3d base = place(-1) - place(1);
  // Where |p_left + s a − (p_right + t b)| is least. Source: Hartley, Sturm, Triangulation, 1997.
  const double ab = a.dot(b), denominator = 1 - ab * ab;
  if (denominator < 1e-9) return std::nullopt;
  const double s = (base.dot(a) - base.dot(b) * ab) / denominator;
  const double t = (base.dot(a) * ab - base.dot(b)) / denominator;
  if (s <= 0 || t <= 0) return std::nullopt;
  const Vector3d one = place(1) + s * a, other = place(-1) + t * b;
  if ((one - other).norm() > gap * std::min(s, t)) return std::nullopt;
  return (one + other) / 2;
}

}  // namespace hc::gaze
