// SPDX-License-Identifier: Apache-2.0
#include "targets.h"

using hc::gaze::Side;

hc::Status Targets::calibrate(const hc::vision::StereoCalibration& cameras) {
  cameras_ = cameras;
  eyes_.set_baseline(cameras.baseline());
  eyes_.set_offset(cameras.R_left_right());
  if (cameras.head.empty()) return {};
  auto of_head = HC_TRY(hc::gaze::HeadCalibration::of(cameras.head));
  calibrate(of_head);
  return {};
}

std::int32_t Targets::frame_of(std::int32_t coord) {
  const bool is_seen_by_eye =
      coord == kLeftEye || coord == kRightEye || coord == kLeftImage || coord == kRightImage;
  return is_seen_by_eye ? kHead : coord;
}

void Targets::see(hc::Time time, std::int32_t coord, const Eigen::Vector3d& p,
                  const Eigen::Isometry3d& T_robot_frame) {
  std::optional<Eigen::Vector3d> in_frame = p;
  if (frame_of(coord) != coord) {
    const bool is_left = (coord == kLeftEye || coord == kLeftImage) != eyes_.swapped();
    const Side side = is_left ? Side::Left : Side::Right;
    if (coord == kLeftImage || coord == kRightImage)
      in_frame = place(time, side, p.head<2>());
    else
      in_frame = eyes_.T_head_eye(side) * p;
  }
  if (!in_frame) return;
  follower_.see(hc::seconds(time.time_since_epoch()),
                hc::gaze::aim(T_robot_frame * *in_frame, eyes_.cyclopean()));
}

std::optional<Eigen::Vector3d> Targets::place(hc::Time time, Side side, Eigen::Vector2d pixel) {
  if (cameras_) {
    const auto eye = side == Side::Left ? hc::vision::Eye::Left : hc::vision::Eye::Right;
    const auto ray = hc::vision::ray_of(*cameras_, eye, {pixel.x(), pixel.y()});
    pixel = {eyes_.cx + eyes_.focal * ray[0], eyes_.cy + eyes_.focal * ray[1]};
  }
  return binocular_.see(eyes_, side, time, pixel, distance_);
}
