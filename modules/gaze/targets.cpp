// SPDX-License-Identifier: Apache-2.0
#include "targets.h"

namespace {

constexpr std::int64_t kSetBack = 1'000'000'000;  // a report so far back is of another clock [ns]
constexpr std::size_t kMostWaiting = 64;

}  // namespace

double seconds(std::int64_t time) {
  return static_cast<double>(time) * 1e-9;
}

hc::Status Targets::know(const hc::vision::StereoCalibration& cameras) {
  hc::gaze::HeadCalibration calibration;
  calibration.offset = hc::gaze::rotation_vector(cameras.R_left_right());
  if (!cameras.head.empty()) {
    auto of_head = hc::gaze::HeadCalibration::of(cameras.head);
    if (!of_head) return of_head.error();
    calibration = *of_head;
  }
  cameras_ = cameras;
  eyes_.baseline = cameras.baseline();
  know(calibration);
  return {};
}

void Targets::report(std::int64_t time, const Eigen::Quaterniond& R_robot_head) {
  if (!gazes_.empty() && gazes_.known().last - time > kSetBack) gazes_.clear();
  hc::frames::Pose pose;
  pose.q = R_robot_head;
  gazes_.add(time, pose);
}

Eigen::Quaterniond Targets::R_robot_head(std::int64_t time) const {
  return gazes_.empty() ? Eigen::Quaterniond::Identity() : gazes_.nearest(time).q;
}

bool Targets::can_see(std::int32_t coord) {
  return coord == kLeftImage || coord == kRightImage || coord == kHead || coord == kRobot;
}

void Targets::see(std::int64_t time, std::int32_t coord, const Eigen::Vector3d& p) {
  if (waiting_.size() == kMostWaiting) waiting_.pop_front();
  waiting_.push_back({time, coord, p});
}

void Targets::take_in(std::int64_t now) {
  for (; !waiting_.empty() && !gazes_.awaits(waiting_.front().time, now); waiting_.pop_front())
    take_in(waiting_.front());
}

void Targets::take_in(const Seen& seen) {
  auto p = std::optional(seen.p);
  if (seen.coord == kLeftImage || seen.coord == kRightImage) {
    const bool is_left = (seen.coord == kLeftImage) != eyes_.calibration.swapped;
    Eigen::Vector2d pixel = seen.p.head<2>();
    if (cameras_) {
      const auto ray =
          hc::vision::ray_of(*cameras_, is_left ? hc::vision::Eye::Left : hc::vision::Eye::Right,
                             {pixel.x(), pixel.y()});
      pixel = {eyes_.cx + eyes_.focal * ray[0], eyes_.cy + eyes_.focal * ray[1]};
    }
    p = binocular_.see(eyes_, is_left ? hc::gaze::Side::Left : hc::gaze::Side::Right, seen.time,
                       pixel, distance_);
  }
  if (!p) return;
  if (seen.coord != kRobot) p = R_robot_head(seen.time) * *p;
  follower_.see(seconds(seen.time), hc::gaze::aim(*p, eyes_.cyclopean()));
}
