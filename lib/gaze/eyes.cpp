// SPDX-License-Identifier: Apache-2.0
#include <gaze/eyes.h>

#include <algorithm>
#include <cmath>

namespace hc::gaze {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d rotation_vector(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

Eigen::Matrix3d HeadCalibration::R_left_right() const {
  const double angle = offset.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, offset / angle).matrix();
}

std::array<double, 7> HeadCalibration::numbers() const {
  return {swapped ? 1.0 : 0.0, zero.pan, zero.tilt, offset.z(), offset.x(), offset.y(), rms};
}

Result<HeadCalibration> HeadCalibration::of(std::span<const double> numbers) {
  constexpr double kMost = 0.8;  // [rad]
  if (numbers.size() != 7) return Error{Code::Malformed, "a head's calibration has 7 numbers"};
  for (const double angle : numbers.subspan(1, 5))
    if (!(std::abs(angle) <= kMost))
      return Error{Code::Malformed, "a head's calibration: an angle of more than 0.8 rad"};
  if ((numbers[0] != 0 && numbers[0] != 1) || !std::isfinite(numbers[6]))
    return Error{Code::Malformed, "a head's calibration: what is no number of one"};
  return HeadCalibration{
      numbers[0] == 1, {numbers[1], numbers[2]}, {numbers[4], numbers[5], numbers[3]}, numbers[6]};
}

Vector3d Eyes::place(Side side) const {
  const double left = side == Side::Left ? baseline / 2 : -baseline / 2;
  return rotation(calibration.zero) * (middle + Vector3d(0, left, 0));
}

Sight Eyes::cyclopean() const {
  const auto R_head_bar = rotation(calibration.zero);
  return {R_head_bar * middle, R_head_bar * Vector3d::UnitX()};
}

Vector3d Eyes::direction(Side side, const Vector2d& pixel) const {
  Vector3d seen((pixel.x() - cx) / focal, (pixel.y() - cy) / focal, 1);
  if (side == Side::Right) seen = calibration.R_left_right() * seen;
  // From the optical frame (x right, y down, z forward).
  return rotation(calibration.zero) * Vector3d(seen.z(), -seen.x(), -seen.y()).normalized();
}

std::optional<Vector3d> Eyes::place_of(const Vector2d& left, const Vector2d& right,
                                       double gap) const {
  const Vector3d a = direction(Side::Left, left), b = direction(Side::Right, right);
  const Vector3d from = place(Side::Left), other_from = place(Side::Right);
  const Vector3d base = other_from - from;
  // Where |p_left + s a − (p_right + t b)| is least. Source: Hartley, Sturm, Triangulation, 1997.
  const double ab = a.dot(b), denominator = 1 - ab * ab;
  if (denominator < 1e-9) return std::nullopt;
  const double s = (base.dot(a) - base.dot(b) * ab) / denominator;
  const double t = (base.dot(a) * ab - base.dot(b)) / denominator;
  if (s <= 0 || t <= 0) return std::nullopt;
  const Vector3d one = from + s * a, other = other_from + t * b;
  if ((one - other).norm() > gap * std::min(s, t)) return std::nullopt;
  return (one + other) / 2;
}

}  // namespace hc::gaze
