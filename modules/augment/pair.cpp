// SPDX-License-Identifier: Apache-2.0
#include "pair.h"

bool Pair::set_intrinsics(std::span<const double> numbers) {
  const bool is_pair = numbers.size() == 5 && hc::finite(numbers) && numbers[0] > 0 &&
                       numbers[1] > 0 && numbers[4] > 0;
  if (!is_pair) return false;
  fx_ = numbers[0];
  fy_ = numbers[1];
  cx_ = numbers[2];
  cy_ = numbers[3];
  baseline_ = numbers[4];
  return true;
}

void Pair::set_camera(const hc::TimedPose& pose) {
  if (pose.to == hc::Coord::kLeftEye && pose.from == hc::Coord::kLeftRectified)
    T_left_rectified_ = pose.T_to_from;
  else if (pose.to == hc::Coord::kHead && pose.from == hc::Coord::kLeftEye)
    T_head_left_ = pose.T_to_from;
}

Sight Pair::at(const hc::Header& image, double focal, hc::ModuleFrames& frames) const {
  const bool is_known = fx_ > 0;
  Sight sight;
  sight.time = image.time;
  auto& camera = sight.camera;
  camera.width = image.width;
  camera.height = image.height;
  camera.fx = is_known ? fx_ : focal;
  camera.fy = is_known ? fy_ : focal;
  camera.cx = is_known ? cx_ : (image.width - 1) / 2.0;
  camera.cy = is_known ? cy_ : (image.height - 1) / 2.0;
  const double baseline =
      is_known ? baseline_ : frames.fixed("left_eye", "right_eye").translation().norm();
  sight.scale = camera.fx * baseline;
  const auto pose = [&](std::string_view frame) {
    const auto known = frames.lookup("world", frame, image.time);
    return known ? *known : frames.nearest("world", frame, image.time);
  };
  auto& [left, right] = sight.T_world_eye;
  left = (T_head_left_ ? pose("head") * *T_head_left_ : pose("left_eye")) * T_left_rectified_;
  right = left * Eigen::Translation3d(baseline, 0, 0);
  return sight;
}
