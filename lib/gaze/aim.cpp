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

Angles aim(const Vector3d& p_robot, const Sight& eye) {
  // The point on the eye's ray that is as far from the axes as the target. A turn about the axes
  // then moves it to the target.
  const double along = eye.place.dot(eye.direction);
  const double range =
      std::sqrt(std::max(along * along - eye.place.squaredNorm() + p_robot.squaredNorm(), 0.0));
  const Vector3d p_head = eye.place + (range - along) * eye.direction;
  // Tilt adjusts the height, then pan the direction.
  const double radius = std::hypot(p_head.x(), p_head.z());
  const double height = radius > 0 ? std::clamp(p_robot.z() / radius, -1.0, 1.0) : 0;
  const double tilt = std::atan2(p_head.z(), p_head.x()) - std::asin(height);
  const double forward = p_head.x() * std::cos(tilt) + p_head.z() * std::sin(tilt);
  const double pan = std::atan2(p_robot.y(), p_robot.x()) - std::atan2(p_head.y(), forward);
  return {std::remainder(pan, 2 * M_PI), std::remainder(tilt, 2 * M_PI)};
}

}  // namespace hc::gaze
