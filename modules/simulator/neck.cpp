// SPDX-License-Identifier: Apache-2.0
#include "neck.h"

#include "head.h"

void Neck::add(std::int64_t time, const Eigen::Quaterniond& R_robot_head) {
  hc::frames::Pose pose;
  pose.q = R_robot_head;
  gazes_.add(time, pose);
}

Eigen::Isometry3d Neck::at(std::int64_t time) const {
  Eigen::Isometry3d T_world_head(Eigen::Translation3d(0, 0, kNeckHeight));
  if (gazes_.empty()) return T_world_head;
  return T_world_head * gazes_.nearest(time).transformation();
}
