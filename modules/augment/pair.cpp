// SPDX-License-Identifier: Apache-2.0
#include "pair.h"

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
  auto& [left, right] = sight.T_world_eye;
  left = mount_.pose_in("world", image.time, frames);
  right = left * Eigen::Translation3d(intrinsics.baseline, 0, 0);
  return sight;
}
