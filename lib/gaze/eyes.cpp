// SPDX-License-Identifier: Apache-2.0
#include <gaze/eyes.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace hc::gaze {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d rotation_vector(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

Eigen::Matrix3d optical() {
  return (Eigen::Matrix3d() << 0, 0, 1, -1, 0, 0, 0, -1, 0).finished();
}

Eigen::Matrix3d HeadCalibration::R_left_right() const {
  const double angle = offset.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, offset / angle).matrix();
}

std::array<double, 7> HeadCalibration::numbers() const {
  const double pitch = offset.x(), yaw = offset.y(), roll = offset.z();
  return {swapped ? 1.0 : 0.0, zero.pan, zero.tilt, roll, pitch, yaw, rms};
}

Result<HeadCalibration> HeadCalibration::of(std::span<const double> numbers) {
  constexpr double kMaxAngle = 0.8;  // [rad]
  const auto refused = [](const char* why) {
    return Error{Code::Malformed, std::string("a head calibration ") + why};
  };
  if (numbers.size() != 7) return refused("must have 7 numbers");
  const double swapped = numbers[0], pan = numbers[1], tilt = numbers[2];
  const double roll = numbers[3], pitch = numbers[4], yaw = numbers[5], rms = numbers[6];
  if (swapped != 0 && swapped != 1) return refused("must start with 0 or 1 (eyes swapped)");
  for (const double angle : {pan, tilt, roll, pitch, yaw})
    if (!(std::abs(angle) <= kMaxAngle)) return refused("must not have angles above 0.8 rad");
  if (!std::isfinite(rms)) return refused("must have a finite RMS");
  return HeadCalibration{swapped == 1, {pan, tilt}, {pitch, yaw, roll}, rms};
}

double Eyes::baseline() const {
  return (place(Side::Left) - place(Side::Right)).norm();
}

void Eyes::set_baseline(double baseline) {
  const Vector3d middle = (mounted_[0].translation() + mounted_[1].translation()) / 2;
  const Vector3d half =
      baseline / 2 * (mounted_[0].translation() - mounted_[1].translation()).normalized();
  mounted_[0].translation() = middle + half;
  mounted_[1].translation() = middle - half;
  T_head_eye_ = mounted_;
}

void Eyes::set_offset(const Eigen::Matrix3d& R_left_right) {
  T_head_eye_[1].linear() = T_head_eye_[0].linear() * R_left_right;
}

void Eyes::calibrate(const HeadCalibration& calibration) {
  const Eigen::Quaterniond mounted(mounted_[0].linear());
  const auto looks_to = angles_of(mounted * Eigen::Quaterniond(optical().transpose()));
  const Eigen::Quaterniond bar = rotation(calibration.zero) * rotation(looks_to).conjugate();
  for (std::size_t i = 0; i < 2; ++i) T_head_eye_[i] = bar * mounted_[i];
  set_offset(calibration.R_left_right());
  swapped_ = calibration.swapped;
}

Sight Eyes::cyclopean() const {
  return {(place(Side::Left) + place(Side::Right)) / 2,
          T_head_eye(Side::Left).linear() * Vector3d::UnitZ()};
}

Vector3d Eyes::direction(Side side, const Vector2d& pixel) const {
  const Vector3d seen((pixel.x() - cx) / focal, (pixel.y() - cy) / focal, 1);
  return T_head_eye(side).linear() * seen.normalized();
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
