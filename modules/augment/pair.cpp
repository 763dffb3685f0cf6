// SPDX-License-Identifier: Apache-2.0
#include "pair.h"

void Pair::set_camera(const hc::TimedPose& pose) {
  if (pose.to == hc::Coord::kLeftEye && pose.from == hc::Coord::kLeftRectified)
    T_left_rectified_ = pose.T_to_from;
  else if (pose.to == hc::Coord::kHead && pose.from == hc::Coord::kLeftEye)
    T_head_left_ = pose.T_to_from;
}

Sight Pair::at(const hc::Header& image, const hc::vision::PairIntrinsics& intrinsics,
               hc::ModuleFrames& frames) const {
  Sight sight;
  sight.time = image.time;
  auto& camera = sight.camera;
  camera.width = image.width;
  camera.height = image.height;
  camera.fx = intrinsics.fx;
  camera.fy = intrinsics.fy;
  camera.cx = intrinsics.cx;
  camera.cy = intrinsics.cy;
  sight.scale = camera.fx * intrinsics.baseline;
  const auto pose = [&](std::string_view frame) {
    const auto known = frames.lookup("world", frame, image.time);
    return known ? *known : frames.nearest("world", frame, image.time);
  };
  auto& [left, right] = sight.T_world_eye;
  left = (T_head_left_ ? pose("head") * *T_head_left_ : pose("left_eye")) * T_left_rectified_;
  right = left * Eigen::Translation3d(intrinsics.baseline, 0, 0);
  return sight;
}
